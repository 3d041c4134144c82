#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "balancer/policy_interface/policy_list.hpp"
#include "base/bytes.hpp"
#include "driftmesh/pslg.hpp"
#include "job/domain.hpp"
#include "job/limits.hpp"
#include "job/rasters.hpp"
#include "job/request.hpp"
#include "job/team.hpp"
#include "job/triangulated.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh::job {

/// A domain that is not cut.
struct Whole {
  Domain domain;
  Triangulated triangulated;  ///< refers to the domain's size field
};

/// What outlives a run that ends before its time.
struct Keeping {
  std::string checkpoint{};              ///< the file where the work is kept; empty: none
  double every = 0;                      ///< seconds between two checkpoints
  std::string resume{};                  ///< the file with work to go on with; empty: none
  std::map<std::string, Bytes> heads{};  ///< what a checkpoint says of the run; for rank 0 alone
};

/// What is to be refined, and how: what rank 0 sends to all ranks. It refers to nothing outside: the others
/// make or are given a size field of their own.
struct Order {
  RunPlan plan;
  Pslg pslg;  ///< repaired
  Request::Sizing sizing;
  Request::Limits limits;
  Request::Patience patience;     ///< with ranks that do not answer
  IdVector<Rank, double> shares;  ///< fraction of its time that each rank works, for experiments; empty: all of it
  Use use;                        ///< what the mesh is for
  std::string scratch{};          ///< folder where subdomains sleep; empty: in memory
  Keeping keeping{};              ///< how work is kept, if it is made in rounds
  Rasters rasters{};              ///< open; others than rank 0 open them themselves
  std::shared_ptr<const SizeField> size{};  ///< what the domain was cut for; for this process alone
  std::shared_ptr<const TimeStep> step{};   ///< what triangles are to allow; others than rank 0 make it themselves
  std::optional<Whole> whole{};             ///< in place of plan and input, for one piece, which stays where it is
};

/// Shares the order that rank 0 makes with all ranks. Collective; only rank 0 calls `make`. An exception from it is
/// thrown there, and an error of the same type and with the same message on the others; one that prevents another rank
/// from following the order is thrown on all. `policies` makes the plan's policy separately on each rank.
[[nodiscard]] Order share(Team& team, const std::function<Order()>& make,
                          const balancer::PolicyMaker& policies = nullptr);

}  // namespace driftmesh::job
