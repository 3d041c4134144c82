// Ranks that balance where memory is short, and ask each other first.
#include <doctest/doctest.h>

#include <vector>

#include "controller_fixture.hpp"

using namespace driftmesh;
using namespace driftmesh::balancer;
using namespace driftmesh::testing;
using Stage = Admission::Stage;

namespace {

Controller asking_giver(const Layout& layout) {
  Controller giver = controller_of(1_rank, layout, "stealing");
  giver.receive(0_rank, WorkRequest{.thief = 0_rank, .round = 1, .speed = 1000, .free_memory = 6000}, 1);
  return giver;
}

}  // namespace

TEST_CASE("a giver asks a rank that is short of memory, and hands over what is admitted") {
  const Layout layout = grid_layout(40, 1, 2);
  Controller giver = asking_giver(layout);
  const Loads own = loads_of(20, 39, 1000);
  const Decision asked = giver.think(1, own, 1000);
  CHECK(asked.moves.empty());
  CHECK(giver.waiting());
  const auto questions = sent<Admission>(asked);
  REQUIRE(questions.size() == 1);
  CHECK(questions[0].first == 0_rank);
  CHECK(questions[0].second.stage == Stage::kAsk);
  const auto guests = questions[0].second.guests;
  CHECK(guests.size() == 5);  // a little more than 1000 triangles each
  const auto answers = sent<WorkAnswer>(asked);
  REQUIRE(answers.size() == 1);
  CHECK(answers[0].second.moves.size() == 5);

  giver.receive(0_rank, Admission{questions[0].second.round, Stage::kAnswer, {guests[0], guests[1]}}, 1);
  CHECK(giver.due(1));
  const Decision followed = giver.think(1, own, 1000);
  CHECK(followed.moves == std::vector<Move>{{guests[0].subdomain, 0_rank}, {guests[1].subdomain, 0_rank}});
  CHECK(!giver.waiting());
}

TEST_CASE("a rank answers what may come, and does not offer the same memory to others until it has come") {
  const Layout layout = grid_layout(12, 1, 3);
  Controller rank = controller_of(1_rank, layout, "greedy");
  const auto free_memory_told = [&](double now, const Loads& own) {
    const auto reports = sent<LoadReport>(rank.think(now, own, 100, 0, 1000));
    REQUIRE(reports.size() == 1);
    return reports[0].second.free_memory;
  };
  CHECK(free_memory_told(1, loads_of(4, 4, 1000)) == 1000);
  rank.receive(2_rank, Admission{3, Stage::kAsk, {{8_sub, 700}, {9_sub, 400}, {10_sub, 200}}}, 2);
  const auto answers = sent<Admission>(rank.think(2, loads_of(4, 4, 900), 100, 0, 1000));
  REQUIRE(answers.size() == 1);
  CHECK(answers[0].first == 2_rank);
  CHECK(answers[0].second == Admission{3, Stage::kAnswer, {{8_sub, 700}, {10_sub, 200}}});
  CHECK(free_memory_told(10, loads_of(3, 4, 900)) == 100);
  rank.arrived(8_sub, 1);
  CHECK(free_memory_told(20, loads_of(2, 4, 900)) == 800);
  rank.receive(2_rank, Admission{3, Stage::kReturn, {{10_sub, 200}}}, 21);
  static_cast<void>(rank.think(21, loads_of(2, 4, 900), 100, 0, 1000));
  CHECK(free_memory_told(30, loads_of(1, 4, 900)) == 1000);
}

TEST_CASE("a rank that gives up asks nobody any more") {
  Controller giver = asking_giver(grid_layout(40, 1, 2));
  static_cast<void>(giver.think(1, loads_of(20, 39, 1000), 1000));
  REQUIRE(giver.waiting());
  giver.give_up();
  CHECK(!giver.waiting());
  CHECK(!giver.due(99));
}

TEST_CASE("a rank that follows advice asks those that it says may be short of memory") {
  const Layout layout = grid_layout(12, 1, 3);
  Controller rank = controller_of(1_rank, layout, "greedy");
  rank.receive(0_rank, Plan{1, {{4_sub, 0_rank}, {5_sub, 2_rank}, {6_sub, 1_rank}}, {2_rank}}, 1);
  const Decision followed = rank.think(1, loads_of(4, 7, 1000), 100);
  CHECK(followed.moves == std::vector<Move>{{4_sub, 0_rank}});  // 6 is here already
  const auto questions = sent<Admission>(followed);
  REQUIRE(questions.size() == 1);
  CHECK(questions[0].first == 2_rank);
  REQUIRE(questions[0].second.guests.size() == 1);
  CHECK(questions[0].second.guests[0].subdomain == 5_sub);
}

TEST_CASE("a plan names each rank once that may be short of memory, and no others") {
  Controller leader = controller_of(0_rank, grid_layout(12, 1, 3), "greedy");
  leader.receive(1_rank, LoadReport{1, 0, 100, loads_of(0, 11, 1000)}, 1);
  LoadReport idle{1, 0, 100, {}};
  idle.free_memory = 5000;
  leader.receive(2_rank, idle, 1);
  const auto plans = sent<Plan>(leader.think(1, {}, 100));
  REQUIRE(plans.size() == 1);
  CHECK(plans[0].second.round == 1);
  CHECK(plans[0].second.moves.size() == 8);
  CHECK(plans[0].second.ask == std::vector<Rank>{2_rank});
}
