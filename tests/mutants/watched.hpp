#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

namespace driftmesh::mutants {

/// What all workers did.
struct Totals {
  std::uint64_t mutants = 0, accepted = 0, refused = 0, refused_though_declared = 0, failed = 0;
  std::size_t most_bytes = 0;  ///< memory that a mutant took
  double longest = 0;          ///< seconds for a mutant
};

/// What became of one mutant.
struct Result {
  bool accepted = false;
  bool declared = false;
  std::string failure;
};

/// For each mutant.
struct Limits {
  double seconds = 10;
  std::size_t bytes = 400'000'000;  ///< memory at a time
};

/// Calls `work` for every seed, in as many child processes, and `report`, in any of them or here, for those that fail:
/// that return a failure, throw anything, crash, or go beyond the limits. After a crash another process goes on. Leaks
/// are failures, too, where a sanitizer looks for them: of seed 0.
Totals run_watched(std::uint64_t first, std::uint64_t last, unsigned processes, const Limits& limits,
                   const std::function<Result(std::uint64_t seed, unsigned process)>& work,
                   const std::function<void(std::uint64_t seed, const std::string& failure)>& report);

}  // namespace driftmesh::mutants
