#include <doctest/doctest.h>

#include <algorithm>
#include <set>

#include "controller_fixture.hpp"

using namespace driftmesh;
using namespace driftmesh::balancer;
using namespace driftmesh::testing;

TEST_CASE("moves of a plan that took long to make are not forgotten before they can have been made") {
  const Layout layout = grid_layout(12, 1, 3);
  ControllerOptions options;
  options.overhead = 1;  // it plans again at once
  Controller leader(0_rank, std::make_shared<Layout>(layout), make_policy("greedy"), options, 0);
  leader.receive(1_rank, LoadReport{1, 0, 100, loads_of(0, 11, 1000)}, 1);
  leader.receive(2_rank, LoadReport{1, 0, 100, {}}, 1);
  const auto plans = sent<balancer::Plan>(leader.think(1, {}, 100));
  REQUIRE(plans.size() == 1);
  CHECK(plans[0].second.moves.size() == 8);
  leader.took(5);  // longer than it waits for moves

  // Rank 1 has sent them; they have not arrived.
  Loads kept;
  for (const ReportedLoad& load : loads_of(0, 11, 1000))
    if (std::ranges::none_of(plans[0].second.moves, [&](const Move& m) { return m.subdomain == load.subdomain; }))
      kept.push_back(load);
  leader.receive(1_rank, LoadReport{2, 1, 100, kept}, 6.1);
  CHECK(sent<balancer::Plan>(leader.think(6.2, {}, 100)).empty());
}

TEST_CASE("the leader plans when all have reported, and a rank follows") {
  const Layout layout = grid_layout(12, 1, 2);
  const std::shared_ptr<const Policy> greedy = balancer::make_policy("greedy", {});
  Controller leader(0_rank, std::make_shared<Layout>(layout), greedy, planning_early(), 100);
  Controller other = controller_of(1_rank, layout, "greedy", 100);
  CHECK(leader.due(100));
  CHECK(leader.think(100, loads_of(0, 5, 1000), 400).moves.empty());
  CHECK(!leader.due(100.001));

  const Decision report = other.think(100, loads_of(6, 11, 1000), 100);
  REQUIRE(sent<LoadReport>(report).size() == 1);
  CHECK(sent<LoadReport>(report)[0].first == 0_rank);
  leader.receive(1_rank, report.messages[0].message, 100.1);
  CHECK(leader.due(100.1));
  const Decision decision = leader.think(100.1, loads_of(0, 5, 1000), 400);
  CHECK(decision.planned);
  CHECK(decision.moves.empty());
  const auto plans = sent<balancer::Plan>(decision);
  REQUIRE(plans.size() == 1);
  CHECK(plans[0].first == 1_rank);
  REQUIRE(plans[0].second.moves.size() == 4);
  // Those next to the other rank, so that the border between them stays as short.
  for (const SubdomainId id : {6_sub, 7_sub, 8_sub, 9_sub})
    CHECK(std::ranges::count(plans[0].second.moves, Move{id, 0_rank}) == 1);

  // Subdomains that are not here, finished, or not worth their cost stay.
  other.receive(0_rank, plans[0].second, 100.2);
  CHECK(other.waiting());
  Loads here = loads_of(7, 11, 1000);
  here[2].remaining = 1;
  here[2].bytes = 100'000'000;
  const Decision followed = other.think(100.2, here, 100);
  CHECK(!other.waiting());
  CHECK(followed.moves.size() == 2);
  const auto answer = sent<LoadReport>(followed);
  REQUIRE(answer.size() == 1);  // the leader learns the outcome
  CHECK(answer[0].second.plan == plans[0].second.round);
  REQUIRE(answer[0].second.loads.size() == 4);
  CHECK(answer[0].second.loads.back() == ReportedLoad{6_sub, 0, 0, 0});  // gone
}

TEST_CASE("doubts about the work of others do not keep a rank idle") {
  // Rank 1 has all the work, but doubts by half when it will finish.
  const Layout layout = grid_layout(12, 1, 3);
  for (const bool idle : {true, false}) {
    Controller leader = controller_of(0_rank, layout, "greedy");
    leader.receive(1_rank, LoadReport{1, 0, 100, loads_of(4, 7, 1000), 2}, 1);
    leader.receive(2_rank, LoadReport{1, 0, 100, idle ? Loads{} : loads_of(8, 8, 100), 2}, 1);
    const Decision decision = leader.think(1.1, loads_of(0, 1, 1000), 100, 2);
    CHECK(sent<balancer::Plan>(decision).size() == (idle ? 1 : 0));
  }
}

TEST_CASE("diffusion that waits until a partner runs low looks again by itself") {
  const Layout layout = grid_layout(12, 1, 2);
  ControllerOptions options;
  options.interval = 1000;  // no signs of life
  Controller c(0_rank, std::make_shared<Layout>(layout), make_policy("diffusion"), options, 0);
  c.receive(1_rank, LoadReport{1, 0, 100, {{6_sub, 0, 3500, 40}}}, 1);
  CHECK(c.think(1, loads_of(0, 5, 1000), 100).moves.empty());  // rank 1 has work for 35 s, more than half of 60
  CHECK(c.think(1.1, loads_of(0, 5, 1000), 100).moves.empty());
  Loads later = loads_of(1, 5, 1000);  // as expected: nothing new
  later[0].remaining = 900;
  CHECK(!c.think(12, later, 100).moves.empty());  // 24 s of 49
}

TEST_CASE("adjacent ranks are told every subdomain, distant partners only their sum") {
  const Layout layout = grid_layout(80, 1, 16);  // five each
  Controller c = controller_of(4_rank, layout, "diffusion");
  const auto reports = sent<LoadReport>(c.think(0, loads_of(20, 24, 1000), 100));
  std::set<Rank> told;
  for (const auto& [to, report] : reports) {
    const bool adjacent = to == 3_rank || to == 5_rank;
    CHECK(told.insert(to).second);
    CHECK(report.loads.size() == (adjacent ? 5u : 0u));
    CHECK(report.unlisted == (adjacent ? 0 : 5000));
  }
  CHECK(told == std::set<Rank>{2_rank, 3_rank, 5_rank, 6_rank, 12_rank});
}

TEST_CASE("a rank without work sends none, whatever the plan") {
  const Layout layout = grid_layout(12, 1, 3);
  for (const std::string& policy : policy_names()) {
    CAPTURE(policy);
    for (const Rank self : first_ids<Rank>(3)) {
      Controller c = controller_of(self, layout, policy);
      c.receive(2_rank, balancer::Plan{1, {{0_sub, 1_rank}, {4_sub, 2_rank}, {9_sub, 0_rank}}, {}}, 0);
      c.receive(2_rank, LoadReport{1, 0, 10, loads_of(8, 11, 1e6)}, 0);
      c.receive(2_rank, balancer::LoadNews{1, 4e6, 3e6, 10}, 0);
      c.receive(2_rank, balancer::WorkRequest{2_rank, 1, 0, 10, 0}, 0);
      c.receive(2_rank, balancer::WorkAnswer{7, {{3_sub, self}}}, 0);
      CHECK(c.think(0.1, {}, 100).moves.empty());
    }
  }
}

TEST_CASE("the leader waits with a plan until a rank runs out of work soon") {
  const auto plans_when_left = [](double seconds) {
    Controller leader = controller_of(0_rank, grid_layout(12, 1, 2), "greedy");
    leader.receive(1_rank, LoadReport{1, 0, 100, loads_of(6, 11, 1000)}, 1);
    const Decision decision = leader.think(1, loads_of(0, 5, 100 * seconds / 6), 100);
    return !sent<balancer::Plan>(decision).empty();
  };
  CHECK(!plans_when_left(30));  // 45 seconds on average
  CHECK(!plans_when_left(12));
  CHECK(plans_when_left(8));  // 34 on average
  CHECK(plans_when_left(0));
}

TEST_CASE("listing many subdomains does not take the time of refining them") {
  const Layout layout = grid_layout(4, 1, 2);
  Controller controller = controller_of(0_rank, layout, "stealing");
  static_cast<void>(controller.think(1, loads_of(0, 1, 500), 100));
  CHECK(controller.due(1.1));
  controller.looked(1.005, 0.005);
  CHECK_FALSE(controller.due(1.1));
  CHECK(controller.due(1.3));
  controller.looked(1.3, 0.1);
  controller.receive(1_rank, WorkRequest{1_rank, 1, 0}, 1.4);
  CHECK(controller.due(1.4));  // somebody waits for an answer
}
