#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "driftmesh/mesh.hpp"

namespace driftmesh {

using TriangleNeighbors = std::vector<std::array<std::int32_t, 3>>;

/// Entry [t][i] is the triangle on the other side of the edge opposite vertex i of t, or -1 where there is none.
/// Linear in the number of triangles, whatever the degrees of the vertices. Where more than two triangles share an
/// edge (a broken mesh), they are paired in the order in which they are listed.
[[nodiscard]] TriangleNeighbors triangle_neighbors(const Mesh& mesh);

/// Finds the constrained edge between two vertices in constant time. Most vertices are on no constrained edge, which
/// one bit tells.
class ConstrainedEdgeIndex {
 public:
  explicit ConstrainedEdgeIndex(const Mesh& mesh);

  /// The index into mesh.edges of the edge between a and b (in either direction; the first, if listed twice), or -1.
  [[nodiscard]] std::int32_t find(std::int32_t a, std::int32_t b) const {
    return on_edge_[a] && on_edge_[b] ? look_up(a, b) : -1;
  }
  /// Whether some constrained edge ends at the vertex.
  [[nodiscard]] bool touches(std::int32_t vertex) const { return on_edge_[vertex]; }

 private:
  [[nodiscard]] std::int32_t look_up(std::int32_t a, std::int32_t b) const;
  [[nodiscard]] std::size_t home_slot(std::int32_t low, std::int32_t high) const;

  std::span<const Mesh::Edge> edges_;
  std::vector<bool> on_edge_;
  std::vector<std::int32_t> slots_;  // open addressing, a power of two of them, -1 is empty
};

/// The triangles at each edge of mesh.edges: [0] on the left of a -> b, [1] on the right, -1 where there is none.
[[nodiscard]] std::vector<std::array<std::int32_t, 2>> triangles_at_edges(const Mesh& mesh,
                                                                          const ConstrainedEdgeIndex& index);

/// The indices into mesh.edges of those with a triangle on one side only, in ascending order.
[[nodiscard]] std::vector<std::int32_t> boundary_edges(const Mesh& mesh);

/// The edges on separators: between triangles of different subdomains, and not in mesh.edges. They have this marker.
[[nodiscard]] std::vector<Mesh::Edge> separator_edges(const Mesh& mesh, const TriangleNeighbors& neighbors,
                                                      const ConstrainedEdgeIndex& index, std::int32_t marker);

/// The part of each triangle when mesh.edges cut the mesh apart. Parts are numbered by their first triangles.
[[nodiscard]] std::vector<std::int32_t> parts_between_edges(const Mesh& mesh);

}  // namespace driftmesh
