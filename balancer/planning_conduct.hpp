#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "balancer/conduct.hpp"
#include "balancer/deliberation.hpp"
#include "balancer/knowledge.hpp"
#include "balancer/load_reporter.hpp"
#include "balancer/plan_choice.hpp"
#include "balancer/planning_pace.hpp"
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
  /// Whether a rank that plans has something new to plan on.
  enum class State {
    kUpToDate,  ///< it has planned on all that it knows
    kNews,      ///< something has changed since, or it will be time for what was too early
  };

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
  bool has_just_advised_ = false;        // at the last think()
  std::map<SubdomainId, double> moved_;  // when its last move was planned: it is left alone for a while
};

}  // namespace driftmesh::balancer
