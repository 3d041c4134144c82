#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "balancer/policy_list.hpp"
#include "driftmesh/pslg.hpp"
#include "job/limits.hpp"
#include "job/rasters.hpp"
#include "job/request.hpp"
#include "job/team.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh::job {

/// What rank 0 sends to all ranks before they refine.
struct Order {
  RunPlan plan;  ///< without its size field: each rank makes or is given its own
  Pslg pslg;     ///< repaired
  Request::Sizing sizing;
  Request::Limits limits;
  IdVector<Rank, double> shares;  ///< fraction of its time that each rank works, for experiments; empty: all of it
  Use use;                        ///< of the mesh
  std::string scratch{};          ///< folder where subdomains sleep; empty: in memory
  Rasters rasters{};              ///< open; others than rank 0 open them themselves
};

/// Shares the order that rank 0 makes with all ranks; empty if it makes none because there is no more work. Collective;
/// only rank 0 calls `make`. An exception from it is thrown there, and an error of the same type and with the same
/// message on the others; one that prevents another rank from following the order is thrown on all. `policies` makes
/// the plan's policy separately on each rank.
[[nodiscard]] std::optional<Order> share(Team& team, const std::function<std::optional<Order>()>& make,
                                         const balancer::PolicyMaker& policies = nullptr);

}  // namespace driftmesh::job
