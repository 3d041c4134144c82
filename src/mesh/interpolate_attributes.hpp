#pragma once

#include "mesh/mesh_piece.hpp"
#include "pslg/pslg.hpp"

namespace driftmesh {

/// Gives every added point of `piece` attributes: linear interpolation in the constrained Delaunay triangulation of
/// `pslg`, the repaired input that the piece was made from. Points on a segment of the input so get a mix of its ends;
/// those that rounding put outside the domain get the values of the nearest point of its boundary. Points of the input
/// (which come first, see to_piece) keep their values. Does nothing if the input has no attributes.
void interpolate_attributes(const Pslg& pslg, MeshPiece& piece);

}  // namespace driftmesh
