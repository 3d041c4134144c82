#include "io/read_checks.hpp"

#include <utility>

#include "driftmesh/error.hpp"
#include "driftmesh/id_vector.hpp"
#include "geometry/predicates.hpp"

namespace driftmesh {
namespace {

const char* const kNext = "the file is damaged or was not written completely";

void check_points(const Mesh& mesh, const std::string& path) {
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    if (!in_coordinate_range(mesh.points[v].x) || !in_coordinate_range(mesh.points[v].y))
      throw InputError({path, 0}, "point " + std::to_string(v) + " (counted from 0) is not finite or out of range",
                       kNext);
}

class VertexRange {
 public:
  VertexRange(const Mesh& mesh, const std::string& path) : path_(path), count_(mesh.points.size()) {}
  void check(std::int32_t vertex, const char* what, std::size_t number) const {
    if (to_index(vertex) < count_) return;
    throw InputError({path_, 0},
                     std::string(what) + " " + std::to_string(number) + " (counted from 0) names vertex " +
                         std::to_string(vertex) + " of " + std::to_string(count_),
                     kNext);
  }

 private:
  const std::string& path_;
  std::size_t count_;
};

void check_indices(const Mesh& mesh, const std::string& path) {
  const VertexRange range(mesh, path);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::int32_t vertex : mesh.triangles[t]) range.check(vertex, "triangle", t);
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    range.check(mesh.edges[e].a, "constrained edge", e);
    range.check(mesh.edges[e].b, "constrained edge", e);
  }
}

void check_length(std::size_t length, std::size_t expected, const char* what, const std::string& path) {
  if (length != expected)
    throw InputError({path, 0},
                     std::string(what) + ": " + std::to_string(length) + " values where " + std::to_string(expected) +
                         " are expected",
                     kNext);
}

void check_lengths(const Mesh& mesh, const std::string& path) {
  if (!mesh.point_markers.empty()) check_length(mesh.point_markers.size(), mesh.points.size(), "point markers", path);
  if (!mesh.regions.empty()) check_length(mesh.regions.size(), mesh.triangles.size(), "regions", path);
  if (!mesh.numbers.empty()) check_length(mesh.numbers.size(), mesh.points.size(), "point numbers", path);
  if (!mesh.subdomains.empty()) check_length(mesh.subdomains.size(), mesh.triangles.size(), "subdomains", path);
  if (!mesh.ranks.empty()) check_length(mesh.ranks.size(), mesh.triangles.size(), "ranks", path);
  check_length(mesh.attributes.size(), mesh.attributes_per_point * mesh.points.size(), "point attributes", path);
}

double twice_total_area(const Mesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Point& p = mesh.points[a];
    const Point& q = mesh.points[b];
    const Point& r = mesh.points[c];
    sum += (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
  }
  return sum;
}

}  // namespace

void check_read_mesh(Mesh& mesh, const std::string& path) {
  check_points(mesh, path);
  check_indices(mesh, path);
  check_lengths(mesh, path);
  make_counterclockwise(mesh);
}

void make_counterclockwise(Mesh& mesh) {
  if (twice_total_area(mesh) < 0)
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
}

}  // namespace driftmesh
