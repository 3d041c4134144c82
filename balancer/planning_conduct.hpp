#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "balancer/conduct.hpp"
#include "balancer/deliberation.hpp"
#include "balancer/knowledge.hpp"
#include "balancer/planning_pace.hpp"
#include "balancer/report_rule.hpp"
#include "driftmesh/policy.hpp"

namespace driftmesh::balancer {

/// Behavior of a rank when plans follow from reports (Placement::kLeader, kNeighbors): it reports to the planners,
/// follows their advice, and plans if it is one of them.
class PlanningConduct {
 public:
  PlanningConduct(Rank self, std::shared_ptr<const Layout> layout, std::shared_ptr<const Policy> policy,
                  const ControllerOptions& options, double now);

  void receive(Rank source, Message advice, double now);
  void arrived(SubdomainId id, protocol::Epoch epoch) { mentioned_.push_back({id, epoch, 0, 0}); }
  /// What was on its way here, by other ranks' plans, does not come: they should know why.
  void refused() { acted_ = true; }
  /// A subdomain that should have moved was finished before: whoever planned it counts on that work for its
  /// destination.
  void gone(SubdomainId id) { mentioned_.push_back({.subdomain = id}); }
  [[nodiscard]] bool waiting() const { return !advised_.empty(); }
  [[nodiscard]] bool pressing() const { return waiting(); }
  [[nodiscard]] Decision think(const Situation& situation);
  void took(double seconds);

 private:
  using Loads = std::vector<ReportedLoad>;

  [[nodiscard]] bool plans() const { return knowledge_.has_value(); }
  void follow_advice(const Situation& situation, Loads& own, Decision& decision);
  [[nodiscard]] Verdict judge(const Move& move, const Situation& situation, const Loads& own) const;
  void plan(const Situation& situation, Loads& own, Decision& decision);
  [[nodiscard]] std::vector<Move> worthwhile_plan(const LoadSnapshot& snapshot, const Situation& situation);
  [[nodiscard]] std::vector<Move> better_of(const std::vector<Move>& plan, const std::vector<Move>& few,
                                            const LoadSnapshot& snapshot);
  [[nodiscard]] double finish(const LoadSnapshot& snapshot, std::span<const Move> moves) const;
  [[nodiscard]] std::vector<Move> mended(std::span<const Move> plan, const LoadSnapshot& snapshot, double ideal,
                                         double singly, std::size_t most_moves) const;
  [[nodiscard]] std::size_t most_moves(std::span<const Move> few) const;
  [[nodiscard]] bool affords_whole(const LoadSnapshot& snapshot, const Situation& situation) const;
  [[nodiscard]] double cost_of_whole(const LoadSnapshot& snapshot, const Situation& situation) const;
  void advise(std::span<const Move> moves, const LoadSnapshot& snapshot, Loads& own, Decision& decision);
  [[nodiscard]] std::vector<Rank> to_be_asked(std::span<const Move> moves, const LoadSnapshot& snapshot) const;
  void report(const Situation& situation, const Loads& own, Decision& decision);
  [[nodiscard]] Loads with_mentioned(Loads own) const;
  [[nodiscard]] std::vector<Rank> audience(const Loads& own);

  Rank self_;
  std::shared_ptr<const Layout> layout_;
  std::shared_ptr<const Policy> policy_;
  ControllerOptions options_;

  ReportRule rule_;
  std::uint32_t reports_ = 0;
  std::vector<SubdomainId> told_;  // ascending; of the last report, minus what was handed over since
  Loads mentioned_;     // in the next report, as if finished: what arrived, and what was gone before it could move
  bool acted_ = false;  // on a plan, since the last report
  std::uint32_t plan_seen_ = 0;
  std::vector<Plan> advised_;  // not yet handled
  std::vector<Rank> audience_;

  // Of a rank that plans:
  std::optional<Knowledge> knowledge_;
  bool news_ = false;  // since the last plan
  double start_;
  PlanningPace pace_;
  // Where single moves are had for less, whole plans have a pace of their own:
  bool planned_whole_ = false;  // at the last think()
  double whole_at_ = 0, whole_cost_ = 0, next_whole_ = 0;
  double overruled_gain_ = 0;  // seconds that were to be gained when the last one was not kept
  std::uint32_t plans_ = 0;
  bool advised_now_ = false;             // the last plan was made at the last think()
  std::map<SubdomainId, double> moved_;  // when its last move was planned: it is left alone for a while
};

}  // namespace driftmesh::balancer
