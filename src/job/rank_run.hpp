#pragma once

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
#include "job/team.hpp"
#include "job/watch.hpp"
#include "runtime/rank_loop.hpp"

namespace driftmesh::job {

/// What tests put between a rank and its work. Each may be empty.
struct RankHooks {
  /// The transport that the loop uses in place of this one, which it may wrap. Called right before the loop is made.
  std::function<protocol::Transport&(protocol::Transport&)> through;
  std::function<void(RankLoop&)> before_step;
  std::function<void(const RankLoop::Slice&)> after_slice;
};

/// One rank's part in the refinement of a mesh by a team, and its results. An error on a rank outside its work on
/// subdomains ends the job (see by_itself).
class RankRun {
 public:
  /// `size`: in place of the size field that the order describes, or null; not owned. `team` and `watch` outlive the
  /// object.
  RankRun(Team& team, Order order, const SizeField* size, Watch& watch);

  /// Until all ranks are done. All ranks together. With a log, what each slice of work did is kept. What the work on a
  /// subdomain throws on one rank, or the watch while it goes on, ends it on all in good order, and is thrown on all
  /// alike (see agree_on_failure).
  void refine(bool logs = false, const RankHooks& hooks = {});

  // After that:

  [[nodiscard]] const RankLoop& loop() const { return *loop_; }
  [[nodiscard]] RankReport report() const;
  [[nodiscard]] const RankLog& log() const { return *log_; }
  [[nodiscard]] const RunPlan& plan() const { return order_.plan; }
  [[nodiscard]] const std::vector<Point>& holes() const { return order_.pslg.holes; }
  /// This rank's piece of the whole mesh. Collective.
  [[nodiscard]] DistributedPiece assemble(ExchangeRunner& ranks) const;

 private:
  [[nodiscard]] double share_of_time() const;
  [[nodiscard]] double forecast() const;
  [[nodiscard]] RankLoop::Observers observers(const RankHooks& hooks);
  void run_loop(const RankHooks& hooks);
  [[nodiscard]] protocol::StepResult step_or_abandon();

  Team& team_;
  Order order_;
  std::unique_ptr<const SizeField> size_;  // made here
  Watch& watch_;
  Limits limits_;
  std::unique_ptr<Channel> channel_;
  std::unique_ptr<balancer::Council> council_;  // if the policy needs one
  std::optional<RankLog> log_;
  std::optional<RankLoop> loop_;
  std::exception_ptr failure_;  // of the work on this rank
};

/// One run of a team for rank 0's record: every rank refines what `order` says. On rank 0, adds what all report to
/// `record` and returns what happened when; elsewhere returns nothing of use. All ranks together.
[[nodiscard]] ClusterRun run_with_log(Team& team, Order order, RunRecord& record, Watch& watch);

}  // namespace driftmesh::job
