#pragma once

#include <cstdint>

#include "mesh/triangulation.hpp"

namespace driftmesh {

/// Prepares a triangulation for refinement at its acute corners, so that midpoint splits terminate there.
///
/// Where segments meet inside the domain at less than 60 degrees, splitting one can force a split of the other, and so
/// on forever. The known cure is to cut all segments of such a cluster on common circles around the apex, whose radii
/// are powers of two (Ruppert's shells). Here they are cut once, before refinement: at a power of two that is at most a
/// third of the cluster's shortest segment. The piece between apex and circle becomes a root segment of its own (a
/// shell piece, directed away from the apex). From then on plain midpoint splits stay on common circles, and whether
/// two vertices lie on the same one is a comparison of their dyadic paths.
///
/// A sharp cluster, one with an angle below 20 degrees, is cut on every further power of two as well, as far as each
/// segment reaches; and where neighbors diverge by less than 0.01 radians, the longer one is also cut where the
/// shorter one ends. Pieces that do not line up there would be refined to the distance between the segments.
///
/// Returns the number of clusters. Call once, after triangulate and before refinement.
std::int32_t prepare_corners(Triangulation& mesh);

/// Whether both vertices lie on two segments of one acute corner, at the same distance from its apex: the edge between
/// them cannot be helped by splitting either ("seditious" in Shewchuk and Si's terms). In clusters that are not sharp,
/// the ends of the shell pieces do not count: beyond them, good triangles are cheap.
[[nodiscard]] bool on_same_shell(const Triangulation& mesh, VertexId u, VertexId v);

}  // namespace driftmesh
