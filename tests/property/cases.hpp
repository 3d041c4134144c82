#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>

namespace driftmesh::testing {

/// The number of random cases of a property test: `standard`, a tenth of it under a sanitizer, or the value of the
/// environment variable DRIFTMESH_CASES.
[[nodiscard]] inline std::int64_t case_count(std::int64_t standard) {
  if (const char* wanted = std::getenv("DRIFTMESH_CASES")) return std::strtoll(wanted, nullptr, 10);
#if defined(__SANITIZE_ADDRESS__) || !defined(NDEBUG)
  return standard / 10;
#else
  return standard;
#endif
}

/// A generator that prints its seed, which DRIFTMESH_SEED can set to repeat a failure.
[[nodiscard]] inline std::mt19937_64 seeded_generator(const char* test) {
  const char* wanted = std::getenv("DRIFTMESH_SEED");
  const std::uint64_t seed = wanted ? std::strtoull(wanted, nullptr, 10) : std::random_device{}();
  std::printf("%s: DRIFTMESH_SEED=%llu\n", test, static_cast<unsigned long long>(seed));
  return std::mt19937_64(seed);
}

/// Whether to try one more case after `tried`: up to case_count, or ten times as many as long as what the test must
/// have seen has not occurred.
[[nodiscard]] inline bool more_cases(std::int64_t tried, std::int64_t standard, bool seen_all) {
  const std::int64_t count = case_count(standard);
  return tried < count || (!seen_all && tried < 10 * count);
}

}  // namespace driftmesh::testing
