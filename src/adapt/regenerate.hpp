#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "adapt/demand.hpp"
#include "adapt/fit_lengths.hpp"
#include "adapt/generation.hpp"
#include "driftmesh/ids.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh::adapt {

/// What becomes of a subdomain.
enum class Fate : std::uint8_t {
  kKeep,    ///< it stays as it is, but for points that neighbors put on common borders
  kMend,    ///< only what has to change changes
  kRemake,  ///< it is made anew from its outline
};

/// A subdomain is kept if no triangle is too large, and lengths do not ask for fewer triangles than those by which it
/// was made, by this fraction. It is mended if less than half of it changes.
[[nodiscard]] Fate fate_of(const Part& part, const Demand& demand, double coarsening);

/// What happens meanwhile; may be empty. Exceptions end the work.
struct Hooks {
  std::function<void(std::int64_t triangles, double forecast)> progress{};  ///< by the calling thread
  std::function<void(std::int64_t triangles)> check{};                      ///< by all threads at once
  std::function<void(std::int64_t triangles)> check_all{};  ///< from time to time, with those of all ranks
};

/// The parts of the next generation. Does not depend on the number of threads and ranks. `plan`: that of the first
/// generation, of which the bounds without a size field count. Demands and fates are those of all parts. Throws what
/// refinement and hooks throw, on all ranks. Collective.
[[nodiscard]] Parts regenerate(const RunPlan& plan, const Generation& present, const Wanted& wanted,
                               const IdVector<SubdomainId, Demand>& demands, const IdVector<SubdomainId, Fate>& fates,
                               std::int32_t threads, Ranks& ranks, const Hooks& hooks);

}  // namespace driftmesh::adapt
