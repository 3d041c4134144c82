#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "driftmesh/mesh.hpp"
#include "mesh/mesh_edges.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh::patch {

/// Some triangles of a mesh, with numbers of their own.
struct Part {
  std::vector<std::int32_t> triangle;  ///< the number of each in the whole mesh, ascending
  std::vector<std::int32_t> point;     ///< the same for its points
  std::vector<std::int32_t> edge;      ///< and for its edges: those that are listed between two of the points
  Mesh mesh;                           ///< points, triangles and edges, by own numbers
  TriangleNeighbors beyond;            ///< within the part
};

/// `triangles`: ascending.
[[nodiscard]] Part part_of(const Mesh& mesh, std::vector<std::int32_t> triangles);

/// A mesh whose triangles know their neighbors.
struct Linked {
  TriangleNeighbors beyond;
  Triangulation triangulation;  ///< see triangulation_of
};
/// Throws Error for a mesh that is not sound, or whose triangles do not fit together.
[[nodiscard]] Linked link(const Mesh& mesh);

/// All of a mesh as a part, with what of it is linked already; `linked` is left without neighbors. Nothing: it has
/// points without triangles.
[[nodiscard]] std::optional<Part> whole_part(const Mesh& mesh, Linked& linked);

/// The triangles with their neighbors; all edges without a second triangle are segments. Vertex and triangle numbers
/// are those of the mesh. Throws Error if triangles do not fit together.
[[nodiscard]] Triangulation triangulation_of(const Mesh& mesh, const TriangleNeighbors& beyond);

}  // namespace driftmesh::patch
