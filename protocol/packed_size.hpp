#pragma once

#include <cstdint>

/// How large subdomains are that move, for those who only know how many triangles they have.
namespace driftmesh::protocol {

/// Bytes of the packed form for each triangle: with its half of a vertex, and what refinement has queued. An estimate.
inline constexpr std::uint64_t kBytesPerTriangle = 40;

/// Subdomains with a larger estimated packed size do not move: a message must stay below 2 GiB, and the estimate may be
/// a quarter too low.
inline constexpr std::uint64_t kMostPackedBytes = 1'600'000'000;

}  // namespace driftmesh::protocol
