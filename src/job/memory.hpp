#pragma once

#include <cstdint>

namespace driftmesh::job {

/// The most memory that this process has had, in bytes (its resident set; getrusage).
[[nodiscard]] std::uint64_t peak_memory();
/// What it has now.
[[nodiscard]] std::uint64_t present_memory();
/// What the machine, or the control group that this process runs in, can still give without swapping; 0 if unknown.
[[nodiscard]] std::uint64_t free_memory();

}  // namespace driftmesh::job
