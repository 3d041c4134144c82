#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>

#include "balancer/conduct.hpp"
#include "balancer/council.hpp"
#include "balancer/planning_pace.hpp"
#include "balancer/rank_news.hpp"
#include "balancer/report_rule.hpp"

namespace driftmesh::balancer {

/// Behavior of a rank when all plan at the same time (Placement::kCollective). Ranks report unexpected changes of their
/// load to rank 0. When there is something to gain, rank 0 calls all ranks; they go on refining until all have
/// acknowledged the call, so that nobody waits for a rank in a long slice of work. Then they meet in the council, each
/// with its own subdomains, and hand over what was decided. From the call to the decision no rank is passive: the run
/// cannot end during a round, and no rank can miss one.
class CollectiveConduct {
 public:
  /// `council` must outlive it.
  CollectiveConduct(Rank self, std::shared_ptr<const Layout> layout, const ControllerOptions& options, Council& council,
                    double now);

  void receive(Rank source, const Message& advice, double now);
  void arrived(SubdomainId id, double now);
  [[nodiscard]] bool waiting() const { return stage_ != Stage::kApart; }
  /// All others may be waiting for this rank.
  [[nodiscard]] bool pressing() const { return stage_ == Stage::kStarted; }
  [[nodiscard]] Decision think(const Situation& situation);
  void took(double seconds) { pace_.took(seconds); }

 private:
  enum class Stage {
    kApart,    ///< no round is in progress
    kCalled,   ///< one was called
    kReady,    ///< and the call acknowledged
    kStarted,  ///< all have acknowledged
  };
  using Step = JointRound::Stage;

  [[nodiscard]] bool leads() const { return news_.has_value(); }
  void take_step(const JointRound& step);
  void say_to_all(Step step, Decision& decision) const;
  void call(const Situation& situation, Decision& decision);
  [[nodiscard]] double cost_of_round() const;
  [[nodiscard]] bool last_can_give(const LoadSnapshot& sums) const;
  void answer(Decision& decision);
  void start(Decision& decision);
  void decide(const Situation& situation, Decision& decision);
  void report(const Situation& situation, Decision& decision);
  [[nodiscard]] Contribution contribution(const Situation& situation) const;
  void keep_promise();
  [[nodiscard]] bool expects_work() const { return !promises_.empty(); }
  void forget_old(const Situation& situation);

  Rank self_;
  std::shared_ptr<const Layout> layout_;
  ControllerOptions options_;
  Council& council_;

  Stage stage_ = Stage::kApart;
  std::uint32_t round_ = 0;  // the last one called
  ReportRule rule_;
  std::uint32_t reports_ = 0;
  bool changed_ = false;                // by a decision since the last report
  std::map<SubdomainId, double> came_;  // recent arrivals with their times: they stay for a while
  struct Promise {
    JointPlan::Coming coming;
    double when = 0;
  };
  std::deque<Promise> promises_;  // of decisions, not yet kept, oldest first
  std::int32_t early_ = 0;        // arrived in a round before the decision that promises them was known here

  // Of rank 0:
  std::optional<RankNews> news_;
  bool fresh_ = false;      // since the last check whether there is something to gain
  std::int32_t ready_ = 0;  // ranks that have acknowledged the call
  double start_;
  PlanningPace pace_;
};

}  // namespace driftmesh::balancer
