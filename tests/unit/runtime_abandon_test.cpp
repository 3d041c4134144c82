#include <doctest/doctest.h>

#include <vector>

#include "balancer/policies/policy_factory.hpp"
#include "driftmesh/error.hpp"
#include "runtime_fixture.hpp"
#include "support/abandon_on_errors.hpp"
#include "support/adversarial_network.hpp"

using namespace driftmesh;
using namespace driftmesh::testing;

TEST_CASE("a rank that abandons the run ends it on all ranks, and no message is lost") {
  std::int64_t early = 0;
  for (const char* policy : {"none", "stealing", "diffusion", "zoltan"})
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
      CAPTURE(policy);
      CAPTURE(seed);
      RunPlan plan = plan_of(ell(), {20, {3e-4}, {}, nullptr}, 3, 20, Presplit::kOff);
      plan.balancing.policy = policy;
      plan.balancing.options.look = 3;
      plan.balancing.options.gap = 10;
      plan.balancing.options.interval = 300;
      prepare_balancing(plan, 3, balancer::make_policy);
      protocol::AdversarialNetwork network(3, protocol::Adversary::from_seed(seed));
      SimulatedRanks run(network, 3, plan);
      auto& quitter = run.loops[static_cast<Rank>(seed % 3)];
      bool was_at_work = false;
      run.steps[static_cast<Rank>(seed % 3)] = [&, steps = std::uint64_t{0}]() mutable {
        const auto result = quitter->step();
        if (quitter->abandoned()) CHECK_FALSE(quitter->at_work());
        if (++steps != 4 * seed || result == protocol::StepResult::kFinished) return result;
        was_at_work = quitter->at_work();
        quitter->abandon();
        const Rank next{static_cast<std::int32_t>((seed + 1) % 3)};
        std::vector<SubdomainId> here;
        for (const auto& held : quitter->subdomains()) here.push_back(held.first);
        for (const SubdomainId id : here) CHECK_FALSE(quitter->hand_over(id, next));
        return protocol::StepResult::kBusy;
      };
      REQUIRE(network.run(run.steps).end == protocol::RunEnd::kFinished);
      CHECK(network.in_flight() == 0);
      std::int64_t balance = 0;
      for (const auto& loop : run.loops) {
        if (was_at_work) CHECK(loop->abandoned());
        CHECK_FALSE(loop->at_work());
        balance += loop->protocol().termination().work_balance();
      }
      CHECK(balance == 0);
      early += was_at_work;
    }
  CHECK(early > 40);
}

TEST_CASE("an exception in a slice of work leaves a loop that can abandon the run") {
  struct Breaking final : SizeField {
    bool broken = false;
    double edge_length(const Point& p) const override {
      if (broken && p.x > 1.2) throw Error("no size here");
      return 0.1;
    }
  } field;
  const RunPlan plan = plan_of(ell(), {20, {0}, {}, &field}, 2, 8, Presplit::kOff);
  protocol::AdversarialNetwork network(2, protocol::Adversary::from_seed(1));
  SimulatedRanks run(network, 2, plan);
  field.broken = true;
  int failures = 0;
  abandon_on_errors(run, failures);
  REQUIRE(network.run(run.steps).end == protocol::RunEnd::kFinished);
  CHECK(failures > 0);
  for (const auto& loop : run.loops) CHECK(loop->abandoned());
}
