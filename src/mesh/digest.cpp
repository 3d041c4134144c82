#include "mesh/digest.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <span>

#include "base/mix.hpp"
#include "driftmesh/id_vector.hpp"

namespace driftmesh {
namespace {

constexpr std::size_t kAhead = 16;  // triangles

std::uint64_t bits(double x) {
  return std::bit_cast<std::uint64_t>(x + 0.0);  // -0 + 0 is 0
}

std::uint64_t of_point(const Point& p) {
  return mix(mix(bits(p.x) + kMixStep) + bits(p.y));
}

/// The digest of a directed edge between points with these digests.
std::uint64_t of_edge(std::uint64_t from, std::uint64_t to) {
  return mix(from + 2 * to);
}

/// Digests by triangles, from those of all points: there are six corners to a point.
template <IsId PointId>
class Sum {
 public:
  Sum(const Point* points, std::size_t count) : of_points_(count) {
    std::transform(points, points + count, of_points_.begin(), of_point);
  }

  void add(const std::array<PointId, 3>& triangle) {
    const std::uint64_t a = of_points_[triangle[0]], b = of_points_[triangle[1]], c = of_points_[triangle[2]];
    sum_ += mix(of_edge(a, b) + of_edge(b, c) + of_edge(c, a));
  }
  /// Prefetches what a later triangle needs: otherwise most of the time would be spent waiting for memory.
  void prefetch(const std::array<PointId, 3>& triangle) const {
    for (const PointId i : triangle) __builtin_prefetch(&of_points_[i]);
  }
  [[nodiscard]] std::uint64_t value() const { return sum_; }

 private:
  IdVector<PointId, std::uint64_t> of_points_;
  std::uint64_t sum_ = 0;
};

}  // namespace

std::uint64_t mesh_digest(const Mesh& mesh) {
  Sum<std::int32_t> sum(mesh.points.data(), mesh.points.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (t + kAhead < mesh.triangles.size()) sum.prefetch(mesh.triangles[t + kAhead]);
    sum.add(mesh.triangles[t]);
  }
  return sum.value();
}

std::uint64_t mesh_digest(const Triangulation& mesh) {
  Sum<VertexId> sum(mesh.points.data(), mesh.points.size());
  const std::span triangles(mesh.triangles.data(), mesh.triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (t + kAhead < triangles.size() && triangles[t + kAhead].alive()) sum.prefetch(triangles[t + kAhead].vertex);
    if (triangles[t].alive()) sum.add(triangles[t].vertex);
  }
  return sum.value();
}

}  // namespace driftmesh
