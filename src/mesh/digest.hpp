#pragma once

#include <cstdint>

#include "mesh/mesh_piece.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

/// A 64-bit fingerprint of a mesh: of the set of its triangles, each given by the coordinates of its corners, to the
/// last bit. It depends neither on the numbers of vertices and triangles nor on their order or first corner, so it is
/// the same before and after writing and reading, and the digest of a mesh in parts is the sum (modulo 2^64) of theirs.
/// Equal meshes have equal digests; different ones differ but for a chance of 2^-64. It is no defence against forgery.
///
/// Definition: the sum over all triangles, modulo 2^64, of h(x1, y1, x2, y2, x3, y3), where corner 1 is the least in
/// (x, y) and the others follow counterclockwise. h starts from 0x9E3779B97F4A7C15 and takes in each coordinate's
/// IEEE-754 bits b (-0 as 0) by h = mix(h ^ b), with mix the finalizer of splitmix64 (Steele, Lea and Flood 2014).
[[nodiscard]] std::uint64_t mesh_digest(const MeshPiece& mesh);
[[nodiscard]] std::uint64_t mesh_digest(const Triangulation& mesh);

}  // namespace driftmesh
