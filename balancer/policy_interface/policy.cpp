#include "driftmesh/policy.hpp"

#include <limits>
#include <utility>

namespace driftmesh::balancer {
namespace {

class LeaderPolicy final : public Policy {
 public:
  explicit LeaderPolicy(std::function<std::vector<Move>(const LoadSnapshot&)> plan) : plan_(std::move(plan)) {}
  [[nodiscard]] Placement placement() const override { return Placement::kLeader; }
  [[nodiscard]] std::vector<Move> plan(const LoadSnapshot& snapshot, Rank) const override { return plan_(snapshot); }

 private:
  std::function<std::vector<Move>(const LoadSnapshot&)> plan_;
};

}  // namespace

std::vector<Move> Policy::plan(const LoadSnapshot&, Rank) const {
  return {};
}

std::optional<std::vector<Move>> Policy::touch_up(const LoadSnapshot&) const {
  return std::nullopt;
}

double Policy::planning_seconds(const LoadSnapshot&) const {
  return 0;
}

double Policy::most_moves() const {
  return std::numeric_limits<double>::infinity();
}

bool Policy::runs_low(double) const {
  return false;
}

std::optional<Rank> Policy::victim(const LoadSnapshot&, Rank, const IdVector<Rank, bool>&) const {
  return std::nullopt;
}

std::vector<Move> Policy::give(const LoadSnapshot&, Rank, Rank) const {
  return {};
}

std::shared_ptr<const Policy> leader_policy(std::function<std::vector<Move>(const LoadSnapshot&)> plan) {
  return std::make_shared<LeaderPolicy>(std::move(plan));
}

}  // namespace driftmesh::balancer
