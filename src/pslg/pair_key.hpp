#pragma once

#include <algorithm>
#include <cstdint>

namespace driftmesh {

/// One number for two points, whichever comes first.
[[nodiscard]] inline std::uint64_t pair_key(std::int32_t a, std::int32_t b) {
  return (static_cast<std::uint64_t>(std::min(a, b)) << 32) | static_cast<std::uint32_t>(std::max(a, b));
}

}  // namespace driftmesh
