#include "job/thread_run.hpp"

#include <algorithm>
#include <thread>
#include <utility>

#include "base/in_parts.hpp"
#include "distributed/assembly.hpp"
#include "distributed/exchange.hpp"
#include "distributed/held_subdomains.hpp"
#include "driftmesh/error.hpp"
#include "job/domain.hpp"
#include "job/memory.hpp"
#include "job/rank_report.hpp"

namespace driftmesh::job {

std::int32_t threads_of(const Request& request) {
  if (request.run.threads > 0) return request.run.threads;
  return static_cast<std::int32_t>(std::max(1U, std::thread::hardware_concurrency()));
}

ThreadRun::ThreadRun(Order order, std::int32_t threads, const SizeField* size, Watch& watch)
    : order_(std::move(order)), watch_(watch) {
  for (std::int32_t t = 0; t < threads; ++t) {
    made_.push_back(size_of(order_.sizing, size, order_.pslg).field);
    sizes_.push_back(made_.back().get());
  }
  order_.plan.bounds.size = sizes_.front();
  limits_ = find_limits(order_.limits, order_.pslg, order_.use);
}

void ThreadRun::refine() {
  double forecast = 0;
  for (const Decomposition::Subdomain& s : order_.plan.decomposition.subdomains) forecast += s.predicted;
  refinement_.emplace(
      order_.plan, sizes_,
      RefinementInRounds::Watch{.progress = [=, this](std::int64_t made) { watch_.refining(made, forecast); },
                                .check = [this](std::int64_t made) { check(made); },
                                .stalled = [this](const std::string& why) { watch_.stalled(why); }});
  refinement_->run();
}

void ThreadRun::check(std::int64_t triangles) const {
  const bool by_memory = memory_is_full(limits_, triangles);
  if (by_memory || triangles > limits_.triangles)
    throw LimitError(stopped_message(limits_, by_memory, triangles, true) + ". No mesh was written");
}

void ThreadRun::report(RunRecord& run) const {
  add_facts(run, facts());
  for (const RankOutcome& outcome : refinement_->outcomes()) {
    run.ranks.push_back({outcome, 0});
    run.seconds_refine = std::max(run.seconds_refine, outcome.times.total());
  }
  run.on_threads = true;
  run.rounds = refinement_->rounds();
  run.peak = run.peak_refining = peak_memory();
  add_plan(run, order_.plan);
}

/// Sums are formed in the same order for any number of threads.
MeshFacts ThreadRun::facts() const {
  constexpr std::size_t kBlock = 16;  // subdomains
  std::vector<const Subdomain*> subdomains;
  for (const auto& [id, subdomain] : refinement_->subdomains()) subdomains.push_back(&subdomain);
  std::vector<MeshFacts> blocks((subdomains.size() + kBlock - 1) / kBlock);
  in_parts(blocks.size(), sizes_.size(), [&](std::size_t thread, std::size_t begin, std::size_t end) {
    QualityBounds bounds = order_.plan.bounds;
    bounds.size = sizes_[thread];
    for (std::size_t i = begin * kBlock; i < std::min(end * kBlock, subdomains.size()); ++i)
      add_subdomain(blocks[i / kBlock], order_.plan.decomposition, bounds, *subdomains[i]);
  });
  MeshFacts all;
  for (const MeshFacts& block : blocks) add_facts(all, block);
  return all;
}

DistributedPiece ThreadRun::assemble() const {
  PieceAssembly assembly(Rank{0}, 1, order_.plan.decomposition, held_by_rank(refinement_->subdomains()));
  const IdVector<Rank, Exchange*> alone{&assembly};
  exchange_directly(alone);
  return assembly.piece(order_.pslg);
}

}  // namespace driftmesh::job
