#pragma once

#include <algorithm>
#include <cstdint>
#include <thread>

namespace driftmesh {

/// The number of threads for work that a user gives so many; 0: one for each core.
[[nodiscard]] inline std::int32_t threads_or_cores(std::int32_t asked) {
  return asked > 0 ? asked : static_cast<std::int32_t>(std::max(1U, std::thread::hardware_concurrency()));
}

}  // namespace driftmesh
