#pragma once

#include <cstdint>

namespace driftmesh::job {

// In portable builds all of it is unknown: 0, and no cap.

/// Peak memory of this process in bytes (resident set; getrusage).
[[nodiscard]] std::uint64_t peak_memory();
/// Its current memory.
[[nodiscard]] std::uint64_t present_memory();
/// Memory available without swapping on the machine or in the control group of this process; 0 if unknown.
[[nodiscard]] std::uint64_t free_memory();

/// From now on the system refuses memory (std::bad_alloc) that would let this process grow beyond about `bytes` in all,
/// whichever part of it asks; 0: no more. For programs: the rest of the process is affected, too. What counts is what
/// is mapped (RLIMIT_DATA), so unused capacity of arrays must be small.
void cap_memory(std::uint64_t bytes);
/// What this process can still map under the cap; the largest number if there is none.
[[nodiscard]] std::uint64_t room_under_cap();

}  // namespace driftmesh::job
