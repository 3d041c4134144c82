// What a rank tells the others, and what they take from it.
#include <doctest/doctest.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "balancer/snapshot/knowledge.hpp"
#include "balancer/trigger/report_rule.hpp"
#include "controller_fixture.hpp"
#include "protocol/packed_size.hpp"

using namespace driftmesh;
using namespace driftmesh::balancer;
using namespace driftmesh::testing;

TEST_CASE("a rank that works as reported has nothing to report") {
  ReportRule rule(0.02, 5, 0.1);
  CHECK(!rule.due(0, 1000, 0, false));  // its speed is unknown
  CHECK(rule.due(0, 0, 0, false));      // has no work
  CHECK(rule.due(0.1, 1000, 100, false));
  rule.told(0.1, 1000, 100);
  CHECK(!rule.due(1.1, 900, 100, false));
  CHECK(!rule.due(1.1, 850, 95, false));
  CHECK(rule.due(1.1, 900, 80, false));    // slower than expected
  CHECK(rule.due(1.1, 1200, 100, false));  // more work
  CHECK(rule.due(1.1, 900, 100, true));    // other subdomains
  CHECK(!rule.due(0.11, 900, 80, true));   // but not again at once
  CHECK(rule.due(5.2, 490, 100, false));   // a sign of life
  CHECK(rule.due(9, 0, 100, false));       // finished
  rule.told(10, 0, 100);
  CHECK(!rule.due(100, 0, 100, false));
  CHECK(rule.due(100, 1, 100, false));
}

TEST_CASE("the known load of a rank is extrapolated in the order it reported") {
  Knowledge knowledge(std::make_shared<Layout>(grid_layout(4, 1, 2)), 10);
  CHECK(knowledge.snapshot(0, true).ranks[0_rank].remaining == 2000);  // as the layout predicts
  knowledge.hear(0_rank, {1, 0, 100, {{1_sub, 0, 500, 40}, {0_sub, 0, 300, 40}}}, 1);
  CHECK(!knowledge.complete());
  const LoadSnapshot s = knowledge.snapshot(7, true);
  CHECK(find(s, 1_sub) == nullptr);
  CHECK(find(s, 0_sub)->remaining == 200);
  CHECK(find(s, 0_sub)->owner == 0_rank);
  CHECK(s.ranks[0_rank].remaining == 200);
  CHECK(s.ranks[1_rank].remaining == 2000);
  CHECK(knowledge.snapshot(7, false).ranks[1_rank].remaining == 2000);
  CHECK(knowledge.snapshot(7, false).subdomains.size() == 1);
}

TEST_CASE("late reports cannot move a subdomain back") {
  Knowledge knowledge(std::make_shared<Layout>(grid_layout(4, 1, 2)), 10);
  knowledge.hear(1_rank, {1, 0, 100, {{0_sub, 1, 500, 40}, {2_sub, 0, 500, 40}}}, 1);  // 0 has moved there
  knowledge.hear(0_rank, {1, 0, 100, {{0_sub, 0, 900, 40}, {1_sub, 0, 900, 40}}}, 2);  // sent before it did
  CHECK(knowledge.complete());
  CHECK(knowledge.owner_of(0_sub) == 1_rank);
  const LoadSnapshot s = knowledge.snapshot(2, true);
  CHECK(find(s, 0_sub)->owner == 1_rank);
  CHECK(s.ranks[0_rank].remaining == 900);
  knowledge.hear(1_rank, {1, 0, 100, {}}, 2);  // again, or an older one
  CHECK(find(knowledge.snapshot(2, true), 0_sub)->owner == 1_rank);
}

TEST_CASE("planned moves count as done until their outcome is known") {
  Knowledge knowledge(std::make_shared<Layout>(grid_layout(4, 1, 2)), 10);
  knowledge.hear(0_rank, {1, 0, 100, loads_of(0, 1, 1000)}, 0);
  knowledge.hear(1_rank, {1, 0, 100, loads_of(2, 3, 1000)}, 0);
  const LoadSnapshot before = knowledge.snapshot(0, true);
  knowledge.expect(std::vector<Move>{{0_sub, 1_rank}, {1_sub, 1_rank}}, before, 1, 0);
  CHECK(knowledge.snapshot(0, true).ranks[1_rank].remaining == 4000);
  CHECK(knowledge.in_motion(0_sub));
  // Rank 0 has followed the plan as for 0, and kept 1.
  knowledge.hear(0_rank, {2, 1, 100, loads_of(1, 1, 1000)}, 0);
  CHECK(!knowledge.in_motion(1_sub));
  CHECK(knowledge.in_motion(0_sub));
  CHECK(find(knowledge.snapshot(0, true), 1_sub)->owner == 0_rank);
  CHECK(find(knowledge.snapshot(0, true), 0_sub)->owner == 1_rank);
  // It has arrived.
  knowledge.hear(1_rank, {2, 0, 100, {{2_sub, 0, 1000, 40}, {3_sub, 0, 1000, 40}, {0_sub, 1, 800, 40}}}, 0);
  CHECK(!knowledge.in_motion(0_sub));
  CHECK(find(knowledge.snapshot(0, true), 0_sub)->remaining == 800);
}

TEST_CASE("an owner that has not seen the plan yet does not refuse it") {
  Knowledge knowledge(std::make_shared<Layout>(grid_layout(4, 1, 2)), 10);
  knowledge.hear(0_rank, {1, 0, 100, loads_of(0, 1, 1000)}, 0);
  knowledge.hear(1_rank, {1, 0, 100, loads_of(2, 3, 1000)}, 0);
  knowledge.expect(std::vector<Move>{{0_sub, 1_rank}}, knowledge.snapshot(0, true), 5, 0);
  knowledge.hear(0_rank, {2, 4, 100, loads_of(0, 1, 1000)}, 0);
  CHECK(knowledge.in_motion(0_sub));
  CHECK(find(knowledge.snapshot(0, true), 0_sub)->owner == 1_rank);
  knowledge.hear(0_rank, {3, 5, 100, loads_of(0, 1, 1000)}, 0);
  CHECK(!knowledge.in_motion(0_sub));
}

TEST_CASE("a snapshot lists each subdomain once, where it is or is to be, and takes off the memory for what comes") {
  const double kAtRest = 40.0 / protocol::kBytesPerTriangle;  // triangles that the bytes of loads_of stand for
  Knowledge knowledge(std::make_shared<Layout>(grid_layout(8, 1, 4)), 10);
  LoadReport first{1, 0, 0, loads_of(0, 1, 500)}, second{1, 0, 0, loads_of(2, 3, 300)};
  first.free_memory = 5000, second.free_memory = 7000;
  second.loads.push_back({4_sub, 1, 200, 40});  // from rank 2, which is silent, as is rank 3
  knowledge.hear(0_rank, first, 0);
  knowledge.hear(1_rank, second, 0);
  LoadReport third = second;
  third.round = 2;
  third.loads.push_back({1_sub, 1, 450, 40});  // rank 0 has not said that it left
  knowledge.hear(1_rank, third, 0);
  const LoadSnapshot before = knowledge.snapshot(0, true);
  knowledge.expect(std::vector<Move>{{0_sub, 1_rank}, {5_sub, 0_rank}, {77_sub, 0_rank}}, before, 1, 0);

  const LoadSnapshot s = knowledge.snapshot(0, true);
  REQUIRE(s.subdomains.size() == 8);
  const std::vector<Rank> owners{1_rank, 1_rank, 1_rank, 1_rank, 1_rank, 0_rank, 3_rank, 3_rank};
  const std::vector<double> work{500, 450, 300, 300, 200, 1000, 1000, 1000};
  for (std::size_t i = 0; i < 8; ++i) {
    CAPTURE(i);
    CHECK(s.subdomains[i].id == static_cast<SubdomainId>(i));
    CHECK(s.subdomains[i].owner == owners[i]);
    CHECK(s.subdomains[i].remaining == work[i]);
  }
  CHECK(s.ranks[0_rank].remaining == 1000);
  CHECK(s.ranks[1_rank].remaining == 500 + 450 + 300 + 300 + 200);
  CHECK(s.ranks[2_rank].remaining == 0);
  CHECK(s.ranks[3_rank].remaining == 2000);
  CHECK(s.ranks[0_rank].free_memory == doctest::Approx(5000 - 1000));
  CHECK(s.ranks[1_rank].free_memory == doctest::Approx(7000 - 500 - kAtRest));
  CHECK(s.ranks[2_rank].free_memory == 0);
  const auto coming = knowledge.on_its_way();
  REQUIRE(coming.size() == 2);
  CHECK(coming.at(0_rank) == doctest::Approx(1000));
  CHECK(coming.at(1_rank) == doctest::Approx(500 + kAtRest));
}

TEST_CASE("a planned move without news is forgotten") {
  Knowledge knowledge(std::make_shared<Layout>(grid_layout(4, 1, 2)), 10);
  knowledge.hear(0_rank, {1, 0, 0, loads_of(0, 1, 1000)}, 0);
  knowledge.expect(std::vector<Move>{{0_sub, 1_rank}}, knowledge.snapshot(0, true), 1, 0);
  knowledge.hear(1_rank, {1, 0, 0, loads_of(2, 3, 1000)}, 9);
  CHECK(knowledge.in_motion(0_sub));
  knowledge.hear(1_rank, {2, 0, 0, loads_of(2, 3, 1000)}, 11);
  CHECK(!knowledge.in_motion(0_sub));
}

TEST_CASE("a plan that took long to make is awaited from its end") {
  Knowledge knowledge(std::make_shared<Layout>(grid_layout(4, 1, 2)), 10);
  knowledge.hear(0_rank, {1, 0, 0, loads_of(0, 1, 1000)}, 0);
  knowledge.expect(std::vector<Move>{{0_sub, 1_rank}}, knowledge.snapshot(0, true), 1, 0);
  knowledge.expect(std::vector<Move>{{1_sub, 1_rank}}, knowledge.snapshot(0, true), 2, 0);
  knowledge.put_off(2, 3);
  knowledge.hear(1_rank, {1, 0, 0, {}}, 12);
  CHECK(!knowledge.in_motion(0_sub));
  CHECK(knowledge.in_motion(1_sub));
  knowledge.hear(1_rank, {2, 0, 0, {}}, 14);
  CHECK(!knowledge.in_motion(1_sub));
}

TEST_CASE("knowledge is complete when each rank has reported, however often some have") {
  Knowledge knowledge(std::make_shared<Layout>(grid_layout(6, 1, 3)), 10);
  for (std::uint32_t round = 1; round < 5; ++round) {
    knowledge.hear(0_rank, {round, 0, 0, loads_of(0, 1, 1000)}, 0);
    knowledge.hear(2_rank, {round, 0, 0, loads_of(4, 5, 1000)}, 0);
    CHECK(!knowledge.complete());
  }
  knowledge.hear(1_rank, {1, 0, 0, {}}, 0);
  CHECK(knowledge.complete());
}

TEST_CASE("work that was finished before it could move is not expected at its destination") {
  const Layout layout = grid_layout(12, 1, 2);
  Knowledge knowledge(std::make_shared<Layout>(layout), 10);
  Controller giver = controller_of(1_rank, layout, "greedy");
  const auto reported = sent<LoadReport>(giver.think(1, loads_of(6, 11, 1000), 300));
  REQUIRE(reported.size() == 1);
  knowledge.hear(0_rank, {1, 0, 0, {}}, 1);
  knowledge.hear(1_rank, reported[0].second, 1);
  const std::vector<Move> moves{{10_sub, 0_rank}, {11_sub, 0_rank}};
  knowledge.expect(moves, knowledge.snapshot(1, true), 1, 1);
  CHECK(knowledge.snapshot(1, true).ranks[0_rank].remaining == 2000);

  giver.receive(0_rank, balancer::Plan{1, {{10_sub, 0_rank}, {11_sub, 0_rank}}, {}}, 1.1);
  const Decision followed = giver.think(1.2, loads_of(6, 10, 1000), 300);
  CHECK(followed.moves == std::vector<Move>{{10_sub, 0_rank}});
  const auto answer = sent<LoadReport>(followed);
  REQUIRE(answer.size() == 1);
  knowledge.hear(1_rank, answer[0].second, 1.2);
  CHECK(knowledge.in_motion(10_sub));
  CHECK(!knowledge.in_motion(11_sub));
  CHECK(knowledge.snapshot(1.2, true).ranks[0_rank].remaining == 1000);
}

TEST_CASE("work that is not listed counts, and passes with time") {
  Knowledge knowledge(std::make_shared<const Layout>(grid_layout(4, 1, 2)), 10);
  CHECK(knowledge.snapshot(0, false).ranks[1_rank].remaining == 2000);  // by the layout
  LoadReport report{1, 0, 100, loads_of(2, 2, 300)};
  report.unlisted = 600;
  knowledge.hear(1_rank, report, 0);
  CHECK(knowledge.snapshot(0, false).ranks[1_rank].remaining == 900);
  CHECK(knowledge.snapshot(5, false).ranks[1_rank].remaining == 400);
  CHECK(knowledge.snapshot(9.5, false).ranks[1_rank].remaining == 0);
}

TEST_CASE("the planner of a move learns that it was made, even if the subdomain was finished at once") {
  const Layout layout = grid_layout(12, 1, 2);
  Controller rank = controller_of(1_rank, layout, "greedy");
  CHECK(sent<LoadReport>(rank.think(1, loads_of(6, 11, 1000), 300)).size() == 1);
  rank.arrived(3_sub, 1);
  const auto report = sent<LoadReport>(rank.think(2, loads_of(6, 11, 950), 300));
  REQUIRE(report.size() == 1);
  REQUIRE(report[0].second.loads.size() == 7);
  CHECK(report[0].second.loads.back() == ReportedLoad{3_sub, 1, 0, 0});

  Knowledge knowledge(std::make_shared<Layout>(layout), 3);
  knowledge.hear(0_rank, {1, 0, 300, loads_of(0, 5, 1000)}, 1);
  knowledge.hear(1_rank, {1, 0, 300, loads_of(6, 11, 1000)}, 1);
  knowledge.expect(std::vector<Move>{{3_sub, 1_rank}}, knowledge.snapshot(1, true), 1, 1);
  CHECK(knowledge.in_motion(3_sub));
  knowledge.hear(1_rank, {2, 0, 300, report[0].second.loads}, 2);
  CHECK(!knowledge.in_motion(3_sub));
  CHECK(knowledge.owner_of(3_sub) == 1_rank);
  CHECK(knowledge.snapshot(2, true).ranks[1_rank].remaining == doctest::Approx(6 * 950));
}
