#include "mesh/link_triangles.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "driftmesh/error.hpp"

namespace driftmesh {
namespace {

[[noreturn]] void refuse() {
  throw Error("triangles do not fit together along their edges");
}

/// Half-edges by the lower of their ends. There are few at each end.
class EdgeTable {
 public:
  explicit EdgeTable(const Triangulation& mesh) : mesh_(mesh), begin_(mesh.points.size() + 1, 0) {
    for_each_half_edge([&](HalfEdge, VertexId low) { ++begin_[to_index(low) + 1]; });
    for (std::size_t v = 1; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
    half_edges_.resize(begin_.back());
    std::vector<std::size_t> end(begin_.begin(), begin_.end() - 1);
    for_each_half_edge([&](HalfEdge h, VertexId low) { half_edges_[end[to_index(low)]++] = h; });
  }

  /// The half-edge from a to b, kNone if there is none.
  [[nodiscard]] HalfEdge find(VertexId a, VertexId b) const {
    HalfEdge found = kNone;
    const std::size_t low = to_index(std::min(a, b));
    for (std::size_t i = begin_[low]; i < begin_[low + 1]; ++i) {
      if (mesh_.edge_start(half_edges_[i]) != a || mesh_.edge_end(half_edges_[i]) != b) continue;
      if (found != kNone) refuse();  // two on one side
      found = half_edges_[i];
    }
    return found;
  }

  template <class Visit>
  void for_each_half_edge(Visit&& visit) const {
    for (const TriangleId t : ids_of(mesh_.triangles))
      for (int i = 0; i < 3; ++i) {
        const HalfEdge h = half_edge(t, i);
        visit(h, std::min(mesh_.edge_start(h), mesh_.edge_end(h)));
      }
  }

 private:
  const Triangulation& mesh_;
  std::vector<std::size_t> begin_;  // for each vertex, where its part of half_edges_ begins
  std::vector<HalfEdge> half_edges_;
};

}  // namespace

void link_triangles(Triangulation& mesh) {
  constexpr HalfEdge kUnknown{INT32_MIN};
  const auto neighbor = [&](HalfEdge h) -> HalfEdge& { return mesh.triangles[triangle_of(h)].neighbor[index_of(h)]; };
  for (Triangle& triangle : mesh.triangles) triangle.neighbor.fill(kUnknown);
  const EdgeTable table(mesh);
  for (const SubsegmentId s : ids_of(mesh.subsegments)) {
    Subsegment& segment = mesh.subsegments[s];
    if (!segment.is_leaf()) continue;
    const auto [a, b] = segment.vertex;
    segment.half = {table.find(a, b), table.find(b, a)};
    if (segment.half[0] == kNone && segment.half[1] == kNone) refuse();
    for (const HalfEdge h : segment.half)
      if (h != kNone && std::exchange(neighbor(h), constrained(s)) != kUnknown) refuse();
  }
  table.for_each_half_edge([&](HalfEdge h, VertexId) {
    if (neighbor(h) != kUnknown) return;
    const HalfEdge other = table.find(mesh.edge_end(h), mesh.edge_start(h));
    if (other == kNone || neighbor(other) != kUnknown) refuse();
    neighbor(h) = other;
    neighbor(other) = h;
  });
}

}  // namespace driftmesh
