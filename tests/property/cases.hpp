#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string_view>

namespace driftmesh::testing {

/// The number of random cases of a property test: `standard`, a tenth of it, but one at least, under a sanitizer, or
/// the value of the environment variable DRIFTMESH_CASES.
[[nodiscard]] inline std::int64_t case_count(std::int64_t standard) {
  if (const char* wanted = std::getenv("DRIFTMESH_CASES")) return std::strtoll(wanted, nullptr, 10);
#if defined(__SANITIZE_ADDRESS__) || !defined(NDEBUG)
  return std::max<std::int64_t>(standard / 10, 1);
#else
  return standard;
#endif
}

/// A generator that prints its seed. Without the environment variable DRIFTMESH_SEED the seed is always the same, so
/// that a test judges the change before it and not luck; a number repeats what failed, and `random` draws a new seed,
/// as scripts/nightly.sh does for many runs.
[[nodiscard]] inline std::mt19937_64 seeded_generator(const char* test) {
  const char* wanted = std::getenv("DRIFTMESH_SEED");
  std::uint64_t seed = 1;
  if (wanted && std::string_view(wanted) == "random")
    seed = std::random_device{}();
  else if (wanted)
    seed = std::strtoull(wanted, nullptr, 10);
  std::printf("%s: DRIFTMESH_SEED=%llu\n", test, static_cast<unsigned long long>(seed));
  return std::mt19937_64(seed);
}

/// Whether to try one more case after `tried`: up to case_count, or up to ten times `standard` as long as what the test
/// must have seen has not occurred.
[[nodiscard]] inline bool more_cases(std::int64_t tried, std::int64_t standard, bool seen_all) {
  return tried < case_count(standard) || (!seen_all && tried < 10 * standard);
}

}  // namespace driftmesh::testing
