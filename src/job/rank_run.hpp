#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <optional>

#include "cluster/rank_log.hpp"
#include "distributed/exchange.hpp"
#include "driftmesh/distributed_piece.hpp"
#include "job/limits.hpp"
#include "job/order.hpp"
#include "job/rank_report.hpp"
#include "job/ranks_progress.hpp"
#include "job/team.hpp"
#include "job/watch.hpp"
#include "runtime/crew.hpp"
#include "runtime/subdomain_loop.hpp"

namespace driftmesh::job {

/// Hooks for tests. Each may be empty.
struct RankHooks {
  /// Returns the transport for the loop to use instead of the given one, which it may wrap. Called right before the
  /// loop is created.
  std::function<protocol::Transport&(protocol::Transport&)> through;
  std::function<void(SubdomainLoop&)> before_step;
  std::function<void(const RankLoop::Slice&)> after_slice;
};

/// One rank's part in the refinement of a mesh by a team, and its results. Once it has begun to refine, an error on a
/// rank outside its work on subdomains ends the job (see by_itself).
class RankRun {
 public:
  /// `size`: replaces the size field that the order describes, unless null; not owned. `team` and `watch` outlive the
  /// object. Collective; an error on one rank, or a size field that differs between ranks, is thrown on all.
  RankRun(Team& team, Order order, const Limits& limits, const SizeField* size, Watch& watch);
  ~RankRun();
  RankRun(const RankRun&) = delete;
  RankRun& operator=(const RankRun&) = delete;

  /// Refines until all ranks are done. Collective. With a log, records what each slice of work did. An exception thrown
  /// by the work on a subdomain, by the policy, or by the watch meanwhile, ends refinement on all ranks cleanly and is
  /// thrown on all of them (see agree_on_failure).
  void refine(bool logs = false, const RankHooks& hooks = {});

  // After refine():

  [[nodiscard]] const SubdomainLoop& loop() const { return *loop_; }
  [[nodiscard]] RankReport report();
  [[nodiscard]] const RankLog& log() const { return *log_; }
  [[nodiscard]] const RunPlan& plan() const { return order_.plan; }
  [[nodiscard]] const std::vector<Point>& holes() const { return order_.pslg.holes; }
  /// This rank's piece of the whole mesh. Collective.
  [[nodiscard]] DistributedPiece assemble(ExchangeRunner& ranks) const;

 private:
  void agree_on_size();
  [[nodiscard]] double share_of_time() const;
  [[nodiscard]] RankLoop::Observers observers(const RankHooks& hooks);
  [[nodiscard]] std::function<void(const Subdomain&)> inspection();
  void run_loop(const RankHooks& hooks);
  void hear_of_others(bool shows, bool refines);
  [[nodiscard]] protocol::StepResult step_or_abandon();
  [[nodiscard]] std::exception_ptr stopped(bool by_memory) const;

  Team& team_;
  Order order_;
  std::shared_ptr<const SizeField> size_;
  Watch& watch_;
  Limits limits_;
  std::unique_ptr<ScratchFile> scratch_;  // if subdomains sleep on disk
  std::unique_ptr<Channel> channel_;
  std::optional<RanksProgress> progress_;  // unless the rank is alone
  std::optional<RankLog> log_;
  FactsBook book_;
  std::unique_ptr<Crew> crew_;  // if ranks have several threads
  std::optional<SubdomainLoop> loop_;
  std::int64_t triangles_ = -1;  // when memory was looked at
  std::exception_ptr failure_;   // thrown by the work on this rank
};

}  // namespace driftmesh::job
