#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdint>

namespace driftmesh {

/// values.reserve(count) for a vector or string that is about to be filled. The system clears a page when it is first
/// written, which for many small pages can take longer than the writing: large arrays request huge ones.
template <class Values>
void reserve_in_huge_pages(Values& values, std::size_t count) {
  constexpr std::size_t kHugePage = std::size_t{2} << 20;
  values.reserve(count);
  const auto begin = (reinterpret_cast<std::uintptr_t>(values.data()) + kHugePage - 1) / kHugePage * kHugePage;
  const auto end = reinterpret_cast<std::uintptr_t>(values.data() + count) / kHugePage * kHugePage;
  if (begin < end) madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
}

}  // namespace driftmesh
