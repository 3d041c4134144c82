#pragma once

#include <cstddef>

namespace driftmesh {

/// The place of the calling thread among those that work together, for what each of them has of its own. 0 unless the
/// thread has been given another one.
[[nodiscard]] inline std::size_t& thread_place() {
  static thread_local std::size_t place = 0;
  return place;
}

}  // namespace driftmesh
