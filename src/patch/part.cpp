#include "patch/part.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "driftmesh/error.hpp"
#include "patch/flaws.hpp"

namespace driftmesh::patch {

Part part_of(const Mesh& mesh, std::vector<std::int32_t> triangles) {
  Part part;
  part.triangle = std::move(triangles);
  std::vector<std::int32_t> own(mesh.points.size(), kNone);  // the number of each point in the part
  for (const std::int32_t t : part.triangle)
    for (const std::int32_t v : mesh.triangles[to_index(t)]) own[to_index(v)] = 0;
  for (std::size_t v = 0; v < own.size(); ++v) {
    if (own[v] == kNone) continue;
    own[v] = static_cast<std::int32_t>(part.point.size());
    part.point.push_back(static_cast<std::int32_t>(v));
    part.mesh.points.push_back(mesh.points[v]);
    if (!mesh.point_markers.empty()) part.mesh.point_markers.push_back(mesh.point_markers[v]);
  }
  for (const std::int32_t t : part.triangle) {
    const auto& [a, b, c] = mesh.triangles[to_index(t)];
    part.mesh.triangles.push_back({own[to_index(a)], own[to_index(b)], own[to_index(c)]});
    if (!mesh.regions.empty()) part.mesh.regions.push_back(mesh.regions[to_index(t)]);
  }
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    const auto& [a, b, marker] = mesh.edges[e];
    if (own[to_index(a)] == kNone || own[to_index(b)] == kNone) continue;
    part.edge.push_back(static_cast<std::int32_t>(e));
    part.mesh.edges.push_back({own[to_index(a)], own[to_index(b)], marker});
  }
  part.beyond = triangle_neighbors(part.mesh);
  return part;
}

Linked link(const Mesh& mesh) {
  require_sound(mesh);
  Linked linked{triangle_neighbors(mesh), {}};
  linked.triangulation = with_flaw_of(mesh, [&] { return triangulation_of(mesh, linked.beyond); });
  return linked;
}

std::optional<Part> whole_part(const Mesh& mesh, Linked& linked) {
  std::vector<bool> used(mesh.points.size(), false);
  for (const auto& corners : mesh.triangles)
    for (const std::int32_t v : corners) used[to_index(v)] = true;
  if (std::ranges::find(used, false) != used.end()) return {};
  const auto all = [](std::size_t count) {
    std::vector<std::int32_t> numbers(count);
    std::iota(numbers.begin(), numbers.end(), 0);
    return numbers;
  };
  Part part{all(mesh.triangles.size()), all(mesh.points.size()), all(mesh.edges.size()), {}, std::move(linked.beyond)};
  part.mesh.points = mesh.points;
  part.mesh.point_markers = mesh.point_markers;
  part.mesh.triangles = mesh.triangles;
  part.mesh.regions = mesh.regions;
  part.mesh.edges = mesh.edges;
  return part;
}

namespace {

[[noreturn]] void refuse() {
  throw Error("triangles do not fit together along their edges; look for the place with driftmesh check");
}

/// Edges that have one triangle.
class Rim {
 public:
  explicit Rim(std::size_t points) : has_(points, false) {}
  void add(std::int32_t a, std::int32_t b) {
    edges_.emplace_back(std::min(a, b), std::max(a, b));
    has_[to_index(a)] = has_[to_index(b)] = true;
  }
  /// Refuses edges that it has twice.
  void close() {
    std::ranges::sort(edges_);
    if (std::ranges::adjacent_find(edges_) != edges_.end()) refuse();
  }
  [[nodiscard]] bool has(std::int32_t a, std::int32_t b) const {
    return has_[to_index(a)] && has_[to_index(b)] &&
           std::ranges::binary_search(edges_, std::pair(std::min(a, b), std::max(a, b)));
  }

 private:
  std::vector<bool> has_;  // points
  std::vector<std::pair<std::int32_t, std::int32_t>> edges_;
};

/// The corner of triangle `other` opposite the edge from b to a, beyond which is triangle t.
int corner_beyond(const Mesh& mesh, const TriangleNeighbors& beyond, std::int32_t other, std::int32_t t, std::int32_t a,
                  std::int32_t b) {
  const auto& corners = mesh.triangles[to_index(other)];
  for (int j = 0; j < 3; ++j)
    if (beyond[to_index(other)][to_index(j)] == t && corners[to_index(next(j))] == b &&
        corners[to_index(previous(j))] == a)
      return j;
  refuse();
}

}  // namespace

Triangulation triangulation_of(const Mesh& mesh, const TriangleNeighbors& beyond) {
  Triangulation made;
  made.points.reserve(mesh.points.size());
  made.triangles.reserve(mesh.triangles.size());
  for (std::size_t v = 0; v < mesh.points.size(); ++v) made.add_vertex(mesh.points[v], static_cast<VertexOrigin>(v));
  Rim rim(mesh.points.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& corners = mesh.triangles[i];
    const TriangleId t = made.add_triangle();
    for (int k = 0; k < 3; ++k) {
      made.triangles[t].vertex[k] = VertexId{corners[to_index(k)]};
      const std::int32_t a = corners[to_index(next(k))], b = corners[to_index(previous(k))];
      const std::int32_t other = beyond[i][to_index(k)];
      if (other >= 0) {
        made.triangles[t].neighbor[k] =
            half_edge(TriangleId{other}, corner_beyond(mesh, beyond, other, static_cast<std::int32_t>(i), a, b));
        continue;
      }
      rim.add(a, b);
      const SubsegmentId segment = made.roots[made.add_root(VertexId{a}, VertexId{b}, 0, kNone)].tree;
      made.subsegments[segment].half = {half_edge(t, k), kNone};
      made.triangles[t].neighbor[k] = constrained(segment);
    }
  }
  rim.close();
  for (const TriangleId t : ids_of(made.triangles))
    for (int k = 0; k < 3; ++k)
      if (made.across(half_edge(t, k)) != kNone &&
          rim.has(to_int(made.triangles[t].vertex[next(k)]), to_int(made.triangles[t].vertex[previous(k)])))
        refuse();
  return made;
}

}  // namespace driftmesh::patch
