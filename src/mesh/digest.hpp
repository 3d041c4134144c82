#pragma once

#include <cstdint>

#include "driftmesh/mesh.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

/// A 64-bit fingerprint of a mesh: of the set of its triangles, each given by the coordinates of its corners, to the
/// last bit. It depends neither on the numbers of vertices and triangles nor on their order or first corner, so it is
/// the same before and after writing and reading, and the digest of a mesh in parts is the sum (modulo 2^64) of theirs.
/// Equal meshes have equal digests; different meshes have equal digests with a probability of 2^-64. It does not
/// protect against forgery.
///
/// Definition, all sums modulo 2^64, with mix the finalizer of splitmix64 (Steele, Lea and Flood 2014) and coordinates
/// as the bits of IEEE-754 doubles, -0 as 0: a point has h = mix(mix(x + 0x9E3779B97F4A7C15) + y), an edge from point a
/// to point b has e(a, b) = mix(h(a) + 2 h(b)), a counterclockwise triangle abc has mix(e(a, b) + e(b, c) + e(c, a)),
/// and the mesh the sum over its triangles.
[[nodiscard]] std::uint64_t mesh_digest(const Mesh& mesh);
[[nodiscard]] std::uint64_t mesh_digest(const Triangulation& mesh);

}  // namespace driftmesh
