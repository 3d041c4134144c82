#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "balancer/policy.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/pslg.hpp"
#include "job/request.hpp"
#include "job/team.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh::job {

/// What rank 0 gives to all ranks before they refine.
struct Order {
  RunPlan plan;  ///< its size field is not part of the order: each rank makes its own, or has been given it
  Pslg pslg;     ///< repaired
  Request::Sizing sizing;
  Request::Limits limits;
  IdVector<Rank, double> shares;  ///< of its time that each rank works, for experiments; empty: all of it
  bool writes = false;            ///< the mesh is written or drawn afterwards
};

/// An error of rank 0, as the others hear of it: the message is the same.
class LeaderError : public Error {
 public:
  using Error::Error;
};

/// The order that rank 0 makes, on all ranks; nothing if it makes none, because there is no more to do. All ranks call
/// it together; `make` is called on rank 0 alone. What it throws is thrown there, and as a LeaderError on the others.
/// `policy`: of the plan, where no name stands for it.
[[nodiscard]] std::optional<Order> share(Team& team, const std::function<std::optional<Order>()>& make,
                                         const std::shared_ptr<const balancer::Policy>& policy = nullptr);

}  // namespace driftmesh::job
