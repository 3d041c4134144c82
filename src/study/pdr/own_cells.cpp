#include "study/pdr/own_cells.hpp"

namespace driftmesh::pdr {

void keep_own_triangles(Triangulation& mesh, const CellRefiner& cells, const Lattice& lattice, Rank rank) {
  for (const TriangleId t : ids_of(mesh.triangles))
    if (mesh.triangles[t].alive() && lattice.owner_of(cells.cell_of(t)) != rank) mesh.remove_triangle(t);
}

OwnCounts count_own(const Triangulation& mesh, const Lattice& lattice, Rank rank) {
  const auto owns = [&](VertexId v) { return lattice.owner_of(lattice.cell_of(mesh.points[v])) == rank; };
  OwnCounts counts;
  for (const VertexId v : ids_of(mesh.points)) counts.vertices += mesh.origin[v] != kDeleted && owns(v) ? 1 : 0;
  for (const Subsegment& s : mesh.subsegments) counts.subsegments += s.is_leaf() && owns(s.vertex[0]) ? 1 : 0;
  return counts;
}

}  // namespace driftmesh::pdr
