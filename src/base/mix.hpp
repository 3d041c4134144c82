#pragma once

#include <cstdint>

namespace driftmesh {

/// The finalizer of splitmix64 (Steele, Lea and Flood 2014): one to one, and every bit of the value affects every bit
/// of the result.
[[nodiscard]] constexpr std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
  return z ^ (z >> 31);
}

/// The increment of splitmix64: 2^64 over the golden ratio.
inline constexpr std::uint64_t kMixStep = 0x9E3779B97F4A7C15U;

}  // namespace driftmesh
