#pragma once

#include <cstddef>

namespace driftmesh::mutants {

/// Limits the memory that this process has in addition to what it has now. Beyond it, an allocation throws
/// std::bad_alloc; under the address sanitizer, where it cannot, the process ends with kMemoryExit.
void limit_memory(std::size_t bytes);
inline constexpr int kMemoryExit = 77;

/// Begins to measure: the most memory from now on, as far as it is known (under the address sanitizer).
void start_measuring();
[[nodiscard]] std::size_t most_measured();

}  // namespace driftmesh::mutants
