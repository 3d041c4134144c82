#include <doctest/doctest.h>

#include <memory>
#include <optional>
#include <vector>

#include "driftmesh/error.hpp"
#include "support/abandon_on_errors.hpp"
#include "support/adversarial_network.hpp"
#include "support/plans.hpp"
#include "support/simulated_run.hpp"

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

/// Throws at the `patience`-th question, whichever rank asks it.
class Throwing final : public balancer::Policy {
 public:
  Throwing(balancer::Placement placement, int patience) : placement_(placement), patience_(patience) {}
  [[nodiscard]] balancer::Placement placement() const override { return placement_; }
  [[nodiscard]] std::vector<balancer::Move> plan(const balancer::LoadSnapshot&, Rank) const override {
    answer();
    return {};
  }
  [[nodiscard]] bool runs_low(double) const override { return true; }
  [[nodiscard]] std::optional<Rank> victim(const balancer::LoadSnapshot&, Rank thief,
                                           const IdVector<Rank, bool>& able) const override {
    answer();
    for (const Rank r : ids_of(able))
      if (able[r] && r != thief) return r;
    return {};
  }
  [[nodiscard]] std::vector<balancer::Move> give(const balancer::LoadSnapshot&, Rank, Rank) const override {
    answer();
    return {};
  }
  [[nodiscard]] bool has_thrown() const { return asked_ >= patience_; }

 private:
  void answer() const {
    if (++asked_ >= patience_) throw Error("no plan today");
  }
  balancer::Placement placement_;
  int patience_;
  mutable int asked_ = 0;
};

}  // namespace

TEST_CASE("a policy that throws on one rank ends the run on all of them") {
  using balancer::Placement;
  Pslg square;
  square.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  square.segments = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 0, 1}};
  RunPlan plan = plan_for(square, {20, {1e-3}, {}, nullptr}, 3, 20, Presplit::kOff);
  plan.work.slice = 50;
  plan.balancing.options.look = 3;
  plan.balancing.options.gap = 10;
  plan.balancing.options.interval = 30;
  int runs_ended = 0;
  for (const Placement placement : {Placement::kLeader, Placement::kNeighbors, Placement::kRequests})
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      CAPTURE(static_cast<int>(placement));
      CAPTURE(seed);
      const auto policy = std::make_shared<Throwing>(placement, static_cast<int>(1 + seed % 4));
      prepare_balancing(plan, 3, [&](const auto&...) { return policy; });
      protocol::AdversarialNetwork network(3, protocol::Adversary::from_seed(seed));
      SimulatedRanks run(network, 3, plan);
      int failures = 0;
      abandon_on_errors(run, failures);
      REQUIRE(network.run(run.steps).end == protocol::RunEnd::kFinished);
      CHECK(network.in_flight() == 0);
      CHECK((failures > 0) == policy->has_thrown());
      for (const auto& loop : run.loops) CHECK(loop->abandoned() == policy->has_thrown());
      runs_ended += failures > 0;
    }
  CHECK(runs_ended > 40);
}
