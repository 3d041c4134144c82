#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "balancer/policies/policy_factory.hpp"
#include "mesh/exceptions.hpp"
#include "support/plans.hpp"

namespace driftmesh::testing {

/// The subdomains of a rank that joins a run late.
enum class LateStart {
  kNothing,       ///< none: the others have all subdomains
  kOneSubdomain,  ///< one
  kShare,         ///< as many as any other rank
};

/// One rank that joins a run late.
struct LateCase {
  std::string policy;
  Rank rank{};
  LateStart start = LateStart::kNothing;
};

/// The initial owners of this number of subdomains: round-robin, so that neighbors communicate a lot, except that the
/// late rank's subdomains beyond those it starts with go to the others.
inline IdVector<SubdomainId, Rank> late_owners(std::size_t subdomains, std::int32_t ranks, const LateCase& late) {
  const std::size_t kept = late.start == LateStart::kShare          ? subdomains
                           : late.start == LateStart::kOneSubdomain ? 1
                                                                    : 0;
  IdVector<SubdomainId, Rank> owners;
  Rank turn{};
  for (std::size_t of_late = 0; owners.size() < subdomains; turn = next_in_ring(turn, ranks))
    if (turn != late.rank || of_late++ < kept) owners.push_back(turn);
  return owners;
}

/// The plan of a run that makes about this many triangles of `input`, in 40 subdomains, or 20 a rank, of several
/// slices. Policies check loads often, so that they act within tenths of a second.
inline RunPlan late_plan(const Pslg& input, double triangles, std::int32_t ranks, const LateCase& late) {
  const double area = summarize_angles(triangulate(input)).total_area;
  RunPlan plan =
      plan_for(input, {20, {1.5 * area / triangles}, {}, nullptr}, ranks, std::max(40, 20 * ranks), Presplit::kOff);
  plan.owners = late_owners(plan.owners.size(), ranks, late);
  plan.work.slice = 40;
  plan.work.aggregation = 8;
  plan.balancing.policy = late.policy;
  plan.balancing.options.look = 1e-3;
  plan.balancing.options.gap = 2e-3;
  plan.balancing.options.interval = 2e-2;
  prepare_balancing(plan, ranks, balancer::make_policy);
  return plan;
}

}  // namespace driftmesh::testing
