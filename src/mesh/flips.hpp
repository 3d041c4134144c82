#pragma once

#include <vector>

#include "mesh/triangulation.hpp"

namespace driftmesh {

/// Replaces the edge between two triangles by the other diagonal of their quadrilateral, which must be strictly convex.
/// `h` is the edge seen from one of them and must not be constrained. Both triangles keep their slots; the new edge is
/// returned as half-edge 0 of h's triangle, whose corner 0 was the apex of the other.
HalfEdge flip(Triangulation& mesh, HalfEdge h);

/// Whether flipping `h` (not constrained) is possible: its quadrilateral is strictly convex, decided exactly.
[[nodiscard]] bool is_flippable(const Triangulation& mesh, HalfEdge h);

/// Lawson's algorithm: flips edges until each of `pending`, and every edge affected by a flip, is locally Delaunay or
/// constrained. Consumes `pending`; appends the triangles that changed to `changed` (with repetitions).
void legalize(Triangulation& mesh, std::vector<HalfEdge>& pending, std::vector<TriangleId>& changed);

/// Deletes a free vertex, the apex of half-edge `h`, and fills its star with Delaunay triangles. Appends the triangles
/// that changed to `changed` (with repetitions). Returns false and changes nothing where rounding (constrained segments
/// bend by an ulp at their midpoints) has left a star that cannot be filled.
bool remove_vertex(Triangulation& mesh, HalfEdge h, std::vector<TriangleId>& changed);

/// Undoes the split of a subsegment, the halves of which are leaves: deletes its midpoint, makes it a leaf again, and
/// fills both sides with Delaunay triangles. The slots of the halves remain, unused, until drop_unused_subsegments
/// (renumber.hpp). The rest as for remove_vertex.
bool undo_midpoint(Triangulation& mesh, SubsegmentId s, std::vector<TriangleId>& changed);

}  // namespace driftmesh
