#include <memory>

#include "balancer/planner/surplus.hpp"
#include "driftmesh/policy.hpp"
#include "driftmesh/policy_parameters.hpp"

namespace driftmesh::balancer {
namespace {

/// Moves surplus work to the ranks that would finish it first. Considers work and speed, not borders.
class Greedy final : public Policy {
 public:
  explicit Greedy(double tolerance) : tolerance_(tolerance) {}

  [[nodiscard]] Placement placement() const override { return Placement::kLeader; }
  [[nodiscard]] std::vector<Move> plan(const LoadSnapshot& snapshot, Rank) const override {
    return moves_between(snapshot, deal_surplus(snapshot, tolerance_));
  }

 private:
  double tolerance_;
};

}  // namespace

std::unique_ptr<Policy> make_greedy(Parameters& parameters) {
  return std::make_unique<Greedy>(parameters.number("tolerance", 0.02, 0, 10));
}

}  // namespace driftmesh::balancer
