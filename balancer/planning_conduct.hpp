#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "balancer/conduct.hpp"
#include "balancer/load_reporter.hpp"
#include "balancer/planner/plan_choice.hpp"
#include "balancer/snapshot/deliberation.hpp"
#include "balancer/snapshot/knowledge.hpp"
#include "balancer/snapshot/situation.hpp"
#include "balancer/trigger/controller_options.hpp"
#include "balancer/trigger/planning_pace.hpp"
#include "driftmesh/policy.hpp"

namespace driftmesh::balancer {

/// Behavior of a rank when plans follow from reports (Placement::kLeader, kNeighbors): it reports to the planners,
/// follows their advice, and plans if it is one of them.
class PlanningConduct {
 public:
  PlanningConduct(Rank self, std::shared_ptr<const Layout> layout, std::shared_ptr<const Policy> policy,
                  const ControllerOptions& options, double now);

  void receive(Rank source, Message advice, double now);
  void arrived(SubdomainId id, protocol::Epoch epoch) { reporter_.mention(id, epoch); }
  /// What was on its way here, by other ranks' plans, does not come: they should know why.
  void refused() { reporter_.has_changed(); }
  /// A subdomain that should have moved was finished before: whoever planned it counts on that work for its
  /// destination.
  void gone(SubdomainId id) { reporter_.mention(id); }
  [[nodiscard]] bool waiting() const { return !advised_.empty(); }
  [[nodiscard]] bool pressing() const { return waiting(); }
  [[nodiscard]] Decision think(const Situation& situation);
  void took(double seconds);

 private:
  using Loads = std::vector<ReportedLoad>;
  /// What a rank that plans does next:
  ///
  ///     state        event                                             next state
  ///     kUpToDate    a report comes or is sent                         kNews
  ///     kNews        it is not yet time to plan (PlanningPace)         kNews
  ///     kNews        an even load gains too little, or no moves do     kUpToDate
  ///     kNews        it is too early for moves, for all or for some    kNews
  ///     kNews        moves are advised                                 kUpToDate
  enum class State {
    kUpToDate,  ///< waits: it has planned on all that it knows
    kNews,      ///< plans when the pace allows
  };
  /// What came of the last think(), and so what its duration means:
  ///
  ///     state        event                                             next state
  ///     kSettled     think() advises moves                             kJustSent
  ///     kJustSent    took(): the plan is given that much longer        kSettled
  enum class Advice { kSettled, kJustSent };

  [[nodiscard]] bool plans() const { return knowledge_.has_value(); }
  void follow_advice(const Situation& situation, Loads& own, Decision& decision);
  [[nodiscard]] Verdict judge(const Move& move, const Situation& situation, const Loads& own) const;
  void plan(const Situation& situation, Loads& own, Decision& decision);
  [[nodiscard]] std::vector<Move> plan_with_partners(const LoadSnapshot& snapshot);
  void advise(std::span<const Move> moves, const LoadSnapshot& snapshot, Loads& own, Decision& decision);
  [[nodiscard]] std::vector<Rank> to_be_asked(std::span<const Move> moves, const LoadSnapshot& snapshot) const;
  void report(const Situation& situation, const Loads& own, Decision& decision);
  [[nodiscard]] std::vector<Rank> audience(const Loads& own);

  Rank self_;
  std::shared_ptr<const Layout> layout_;
  std::shared_ptr<const Policy> policy_;
  ControllerOptions options_;

  LoadReporter reporter_;
  std::vector<Plan> advised_;  // not yet handled
  std::vector<Rank> audience_;

  // Only on a rank that plans:
  std::optional<Knowledge> knowledge_;
  State state_ = State::kUpToDate;
  double start_;
  PlanningPace pace_;
  PlanChoice choice_;
  std::uint32_t plans_ = 0;
  Advice advice_ = Advice::kSettled;
  std::map<SubdomainId, double> moved_;  // when its last move was planned: it is left alone for a while
};

}  // namespace driftmesh::balancer
