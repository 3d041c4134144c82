#pragma once

#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <iomanip>
#include <span>
#include <sstream>

namespace driftmesh::testing {

/// Checks that cases 1, 2, ... have the digests that were recorded, and shows the table as it would be now if not.
/// Another library's random numbers make other cases: there nothing is compared.
inline void check_recorded(std::span<const std::uint64_t> recorded,
                           const std::function<std::uint64_t(std::uint64_t seed)>& digest_of_case) {
#ifdef _LIBCPP_VERSION
  constexpr bool kSameNumbers = false;
#else
  constexpr bool kSameNumbers = true;
#endif
  std::size_t others = 0;
  std::ostringstream table;
  for (std::size_t i = 0; i < recorded.size(); ++i) {
    const std::uint64_t digest = digest_of_case(i + 1);
    table << "0x" << std::hex << std::setfill('0') << std::setw(16) << digest << ", ";
    if (!kSameNumbers || digest == recorded[i]) continue;
    ++others;
    CHECK_MESSAGE(digest == recorded[i], "case " << i + 1);
  }
  CHECK_MESSAGE(others == 0, "the table as it would be now: " << table.str());
}

}  // namespace driftmesh::testing
