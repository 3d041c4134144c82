#pragma once

#include "triangle/tables.hpp"

namespace driftmesh::triangle {

// What follows from a mesh with three corners to each triangle: points, triangles, segments with markers.

/// Fills in neighbors, edges and the markers of edges: that of the segment if there is one, or 1 on the boundary, or 0.
void add_edges(Tables& mesh);

/// The points at circumcenters, with edges in the order of those of the mesh, which add_edges has filled in.
[[nodiscard]] Voronoi voronoi_of(const Tables& mesh);

/// Adds the midpoints of all edges, after the points, with markers of edges and mean attributes, so that triangles
/// have six corners. After add_edges.
void add_midpoints(Tables& mesh);

/// Removes points in no triangle.
void jettison_points(Tables& mesh);

}  // namespace driftmesh::triangle
