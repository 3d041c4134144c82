#pragma once

#include "mesh/triangulation.hpp"

namespace driftmesh {

/// The length of edges that details of the input force upon each vertex of a constrained Delaunay triangulation
/// (corners prepared, not refined): the distance to its nearest neighbor, or a part of that to a segment opposite, if
/// less. Roughly the local feature size (Ruppert 1995). Edges between points of one shell of an acute corner do not
/// count, as they do not force anything.
[[nodiscard]] GrowingArray<double, VertexId> feature_sizes(const Triangulation& mesh);

/// Distances across a segment that are smaller than this, relative to its length, are lost in rounding.
inline constexpr double kResolution = 1e-14;

/// The part of the distance to a segment that counts, since it is split where that is best, not at the foot.
inline constexpr double kPartOfHeight = 0.66;

/// Whether the edge joins two points of a shell (see on_same_shell). Quick for vertices of the input.
[[nodiscard]] bool is_shell_edge(const Triangulation& mesh, VertexId u, VertexId v);

/// The distance from vertex i of triangle t to the opposite edge, which has this length, if that is a segment that the
/// vertex obstructs: its foot lies on the segment, and the two are not of one shell. Otherwise infinite, as where it is
/// lost in rounding.
[[nodiscard]] double distance_to_segment(const Triangulation& mesh, TriangleId t, int i, double length,
                                         double twice_area);

}  // namespace driftmesh
