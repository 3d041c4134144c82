#pragma once

#include <cstddef>
#include <memory>

#include "base/mapping.hpp"

namespace driftmesh {

/// values.reserve(count) for a vector or string that is about to be filled. The system clears a page when it is first
/// written, which for many small pages can take longer than the writing: large arrays request huge ones.
template <class Values>
void reserve_in_huge_pages(Values& values, std::size_t count) {
  constexpr std::size_t kHugePage = std::size_t{2} << 20;
  values.reserve(count);
  void* begin = values.data();
  std::size_t room = count * sizeof(*values.data());
  if (std::align(kHugePage, kHugePage, begin, room) != nullptr) request_huge_pages(begin, room / kHugePage * kHugePage);
}

}  // namespace driftmesh
