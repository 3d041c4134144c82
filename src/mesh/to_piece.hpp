#pragma once

#include "driftmesh/mesh.hpp"
#include "driftmesh/pslg.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

/// The triangulation as flat arrays. Points of `pslg` (the one it was made from) that the mesh uses come first, in
/// their order, with their markers and attributes; then the added ones. An added point on a segment takes the segment's
/// marker, a free one 0; the attributes of both are 0 until interpolate_attributes. Each triangle carries the attribute
/// of its region, if there are regions. Names are those of `pslg`.
[[nodiscard]] Mesh to_piece(const Triangulation& mesh, const Pslg& pslg);

}  // namespace driftmesh
