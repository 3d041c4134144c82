#include "bench/cut.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <unordered_map>

#include "base/narrow.hpp"
#include "mesh/mesh_edges.hpp"

namespace driftmesh::bench {
namespace {

constexpr std::int32_t kNoPart = -1;

double area_of(const Mesh& mesh, std::size_t t) {
  const auto corner = [&](int i) { return mesh.points[static_cast<std::size_t>(mesh.triangles[t][i])]; };
  const Point a = corner(0), b = corner(1), c = corner(2);
  return 0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
}

/// Grows parts triangle by triangle, breadth first, until each has its share of the area.
class Parts {
 public:
  Parts(const Mesh& mesh, const TriangleNeighbors& neighbors, std::size_t pieces)
      : mesh_(mesh), neighbors_(neighbors), part_(mesh.triangles.size(), kNoPart) {
    double total = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) total += area_of(mesh, t);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      if (part_[t] == kNoPart) grow_from(t, total / static_cast<double>(pieces));
  }
  [[nodiscard]] const std::vector<std::vector<std::size_t>>& members() const { return members_; }
  /// kNoPart for the outside.
  [[nodiscard]] std::int32_t part(std::int32_t t) const { return t < 0 ? kNoPart : part_[static_cast<std::size_t>(t)]; }

 private:
  void grow_from(std::size_t seed, double area) {
    const auto part = narrow<std::int32_t>(members_.size(), "parts");
    std::vector<std::size_t>& members = members_.emplace_back(1, seed);
    part_[seed] = part;
    area -= area_of(mesh_, seed);
    for (std::size_t i = 0; i < members.size(); ++i)
      for (const std::int32_t other : neighbors_[members[i]]) {
        if (other < 0 || area <= 0 || part_[static_cast<std::size_t>(other)] != kNoPart) continue;
        members.push_back(static_cast<std::size_t>(other));
        part_[members.back()] = part;
        area -= area_of(mesh_, members.back());
      }
  }

  const Mesh& mesh_;
  const TriangleNeighbors& neighbors_;
  std::vector<std::int32_t> part_;
  std::vector<std::vector<std::size_t>> members_;
};

/// Builds the boundary of one part.
class Boundary {
 public:
  Boundary(const Mesh& mesh, const std::vector<Point>& holes) : mesh_(mesh) { pslg_.holes = holes; }

  void add_edge(std::int32_t a, std::int32_t b) { pslg_.segments.push_back({local(a), local(b), 1}); }
  /// Another part's triangle may lie in a hole of this one.
  void exclude(std::int32_t triangle) {
    Point center;
    for (const std::int32_t v : mesh_.triangles[static_cast<std::size_t>(triangle)]) {
      center.x += mesh_.points[static_cast<std::size_t>(v)].x / 3;
      center.y += mesh_.points[static_cast<std::size_t>(v)].y / 3;
    }
    pslg_.holes.push_back(center);
  }
  [[nodiscard]] Pslg take() { return std::move(pslg_); }

 private:
  std::int32_t local(std::int32_t v) {
    const auto [at, is_new] = local_.try_emplace(v, narrow<std::int32_t>(pslg_.points.size(), "points"));
    if (is_new) pslg_.points.push_back(mesh_.points[static_cast<std::size_t>(v)]);
    return at->second;
  }

  const Mesh& mesh_;
  std::unordered_map<std::int32_t, std::int32_t> local_;
  Pslg pslg_;
};

}  // namespace

std::vector<Pslg> cut(const Mesh& coarse, const std::vector<Point>& holes, std::size_t pieces) {
  const TriangleNeighbors neighbors = triangle_neighbors(coarse);
  const Parts parts(coarse, neighbors, pieces);
  std::vector<Pslg> result;
  for (const std::vector<std::size_t>& members : parts.members()) {
    Boundary boundary(coarse, holes);
    const std::int32_t self = narrow<std::int32_t>(result.size(), "parts");
    for (const std::size_t t : members)
      for (std::size_t i = 0; i < 3; ++i) {
        const std::int32_t other = neighbors[t][i];
        if (parts.part(other) == self) continue;
        boundary.add_edge(coarse.triangles[t][(i + 1) % 3], coarse.triangles[t][(i + 2) % 3]);
        if (other >= 0) boundary.exclude(other);
      }
    result.push_back(boundary.take());
  }
  return result;
}

}  // namespace driftmesh::bench
