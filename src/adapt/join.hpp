#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "adapt/demand.hpp"
#include "adapt/fit_lengths.hpp"
#include "adapt/generation.hpp"
#include "adapt/move.hpp"
#include "distributed/ranks.hpp"
#include "driftmesh/ids.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh::adapt {

/// What a generation is made from.
struct Basis {
  const RunPlan& plan;
  Held present;
  const Wanted& wanted;
  const IdVector<SubdomainId, Demand>& demands;
};

/// The same where light subdomains have become one: each point and triangle is there as before, but for numbers.
struct Joined {
  RunPlan plan;
  Holding present;  ///< all but what had to go to another rank has stayed
  Wanted wanted;
  IdVector<SubdomainId, Demand> demands;
  IdVector<SubdomainId, SubdomainId> whole;  ///< what each subdomain has become, or is a part of
  std::vector<SubdomainId> several;          ///< those that are to be made anew, since separators in them are gone
  std::int32_t moved = 0;                    ///< subdomains that went to the rank of the others

  [[nodiscard]] Basis basis() const { return {plan, present, wanted, demands}; }
};

/// Joins those that lengths ask little of (see granularity.hpp), on the rank of the one of which they ask most. What is
/// joined does not depend on ranks. Nothing: there are too few. Collective.
[[nodiscard]] std::optional<Joined> join_light(
    const Basis& from, std::int32_t shares,
    const std::function<Generation(const Decomposition& decomposition, Parts parts)>& assemble, Ranks& ranks);

}  // namespace driftmesh::adapt
