#include "job/rounds_on_ranks.hpp"

#include <utility>

#include "job/domain.hpp"
#include "job/same_on_ranks.hpp"
#include "job/thread_run.hpp"

namespace driftmesh::job {

IdVector<Rank, double> RoundsOnRanks::speeds(const Request& /*request*/) const {
  return IdVector<Rank, double>(to_index(ranks()), 1.0);
}

Order RoundsOnRanks::share(const std::function<Order()>& make) {
  return job::share(team_, [&] {
    Order order = make();
    order.plan.balancing.policy = "none";  // subdomains stay where they are during a round
    order.plan.policy.reset();
    order.plan.layout.reset();
    return order;
  });
}

std::unique_ptr<Refined> RoundsOnRanks::refine(Order&& order, const Limits& limits, const SizeField* size,
                                               Watch& watch) {
  ranks_.agree([&] {
    if (order.size == nullptr) order.size = size_of(order.sizing, order.rasters.open, size, order.pslg).field;
  });
  if (order.size != nullptr) require_same_size(team_, order.plan.decomposition, *order.size);
  auto run = std::make_unique<ThreadRun>(std::move(order), limits, threads_, watch, &ranks_);
  run->refine();
  return run;
}

}  // namespace driftmesh::job
