#include "job/here.hpp"

#include <algorithm>
#include <utility>

#include "base/cores.hpp"
#include "distributed/piece_series.hpp"
#include "job/one_piece.hpp"
#include "job/thread_run.hpp"

namespace driftmesh::job {

Cut Here::cut(const Request& request) const {
  if (kind_ == kSubdomains) return Cut::kAlways;
  const bool one_piece = request.decomposition.subdomains == 1 || request.limits.keep_incomplete;
  return one_piece ? Cut::kNever : Cut::kIfLarge;
}

IdVector<Rank, double> Here::speeds(const Request& /*request*/) const {
  return IdVector<Rank, double>(to_index(threads_), 1.0);
}

std::int32_t Here::pieces(const Decomposition& decomposition) const {
  return PieceSeries::count(decomposition);
}

std::unique_ptr<Refined> Here::refine(Order&& order, const Limits& limits, const SizeField*, Watch& watch) {
  if (order.whole) return refine_in_one_piece(std::move(order), limits, threads_, watch);
  if (order.use.by == kMesh) reuse_memory(order.limits);
  auto run = std::make_unique<ThreadRun>(std::move(order), limits, threads_, watch);
  run->refine();
  return run;
}

std::int32_t threads_of(const Request& request) {
  return threads_or_cores(request.run.threads);
}

}  // namespace driftmesh::job
