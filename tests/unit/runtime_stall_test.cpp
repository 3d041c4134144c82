#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "balancer/policies/policy_factory.hpp"
#include "protocol/transport_layer.hpp"
#include "runtime/watchdog.hpp"
#include "runtime_fixture.hpp"
#include "support/adversarial_network.hpp"
#include "support/id_literals.hpp"

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

struct Clocked final : protocol::TransportLayer {
  using TransportLayer::TransportLayer;
  [[nodiscard]] double now() const override { return time; }
  double time = 0;
};

}  // namespace

TEST_CASE("a rank without work reports a stall only after a long wait") {
  const RunPlan plan = plan_of(ell(), {20, {1e-3}, {}, nullptr}, 2, 6, Presplit::kOn);
  protocol::AdversarialNetwork network(2, {});
  Clocked transport(network.transport(1_rank));
  std::vector<std::string> alarms;
  RankLoop::Observers observers;
  observers.stalled = [&](const std::string& why) { alarms.push_back(why); };
  SubdomainLoop loop(transport, plan, {}, observers);
  while (loop.step() != protocol::StepResult::kIdle) {
  }
  REQUIRE(!loop.at_work());
  // The other rank, which has the token, has not even begun.
  for (; transport.time < 590; transport.time += 10) CHECK(loop.step() == protocol::StepResult::kIdle);
  CHECK(alarms.empty());
  for (; transport.time < 700; transport.time += 10) CHECK(loop.step() == protocol::StepResult::kIdle);
  REQUIRE(!alarms.empty());
  CHECK(alarms[0].find("nothing has moved for 6") == 0);
  CHECK(alarms[0].find("without the token") != std::string::npos);
}

TEST_CASE("a rank that waits for an answer reports a stall soon") {
  RunPlan plan = plan_of(ell(), {20, {1e-3}, {}, nullptr}, 2, 6, Presplit::kOn);
  for (Rank& owner : plan.owners) owner = 0_rank;
  plan.policy = balancer::make_policy("stealing");
  plan.layout = layout_of(plan, 2);
  protocol::AdversarialNetwork network(2, {});
  Clocked transport(network.transport(1_rank));
  std::vector<std::string> alarms;
  RankLoop::Observers observers;
  observers.stalled = [&](const std::string& why) { alarms.push_back(why); };
  SubdomainLoop loop(transport, plan, {}, observers);
  for (; transport.time < 50; transport.time += 1) (void)loop.step();
  REQUIRE(!loop.at_work());
  CHECK(loop.outcome().messages > 0);  // it asks
  CHECK(alarms.empty());
  for (; transport.time < 150; transport.time += 1) (void)loop.step();
  CHECK(!alarms.empty());
}

TEST_CASE("the watchdog barks once per period of patience") {
  Watchdog dog(60);
  CHECK(!dog.barks(1000));
  CHECK(!dog.barks(1059));
  CHECK(dog.barks(1060));
  CHECK(!dog.barks(1061));
  CHECK(dog.barks(1120));
  CHECK(dog.quiet(1120) == 120);
  dog.moved(1121);
  CHECK(!dog.barks(1180));
}
