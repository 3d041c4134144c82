#include <cstdint>

#include "job/memory.hpp"

namespace driftmesh::job {

std::uint64_t peak_memory() {
  return 0;
}

std::uint64_t present_memory() {
  return 0;
}

std::uint64_t free_memory() {
  return 0;
}

void cap_memory(std::uint64_t) {}

std::uint64_t room_under_cap() {
  return UINT64_MAX;
}

}  // namespace driftmesh::job
