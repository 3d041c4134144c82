#pragma once

#include <cstdint>

namespace driftmesh::job {

/// Peak memory of this process in bytes (resident set; getrusage).
[[nodiscard]] std::uint64_t peak_memory();
/// Its current memory.
[[nodiscard]] std::uint64_t present_memory();
/// Memory available without swapping on the machine or in the control group of this process; 0 if unknown.
[[nodiscard]] std::uint64_t free_memory();

}  // namespace driftmesh::job
