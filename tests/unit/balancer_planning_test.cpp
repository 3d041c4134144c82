// When planners plan, who hears of whom, and what does not move twice.
#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "balancer/cost/move_cost.hpp"
#include "balancer/trigger/outlook.hpp"
#include "controller_fixture.hpp"

using namespace driftmesh;
using namespace driftmesh::balancer;
using namespace driftmesh::testing;

namespace {

std::set<SubdomainId> moved_by(const Decision& decision) {
  std::set<SubdomainId> moved;
  for (const Move& move : decision.moves) moved.insert(move.subdomain);
  for (const auto& [rank, plan] : sent<Plan>(decision))
    for (const Move& move : plan.moves) moved.insert(move.subdomain);
  return moved;
}

/// A leader of three ranks that plans whenever there is news, and waits a thousand seconds for its moves.
Controller eager_leader() {
  ControllerOptions options = planning_early();
  options.interval = 1000, options.overhead = 1e9, options.gap = 0.01;
  return {0_rank, std::make_shared<Layout>(grid_layout(20, 1, 2)), make_policy("greedy"), options, 0};
}

}  // namespace

TEST_CASE("advice is looked at at once, and a rank that expects work looks all the time") {
  const Layout layout = grid_layout(12, 1, 3);
  Controller leader = controller_of(0_rank, layout, "greedy");
  static_cast<void>(leader.think(1, loads_of(0, 3, 1000), 100));
  CHECK(!leader.due(1));
  leader.receive(1_rank, LoadReport{1, 0, 100, loads_of(4, 7, 1000)}, 1);
  CHECK(leader.due(1));
  static_cast<void>(leader.think(1, loads_of(0, 3, 1000), 100));
  CHECK(!leader.due(1));

  Controller thief = controller_of(1_rank, layout, "stealing");
  static_cast<void>(thief.think(1, {}, 100));
  thief.receive(2_rank, WorkAnswer{1, {{8_sub, 1_rank}}}, 1);
  static_cast<void>(thief.think(1, {}, 100));
  CHECK(thief.due(1));
  thief.arrived(8_sub, 1);
  static_cast<void>(thief.think(1, loads_of(8, 8, 1000), 100));
  CHECK(!thief.due(1));
}

TEST_CASE("the first plan waits for all ranks, but not for ever") {
  const ControllerOptions options = planning_early();
  const auto planned_at = [&](double now, bool all) {
    Controller leader(0_rank, std::make_shared<Layout>(grid_layout(12, 1, 3)), make_policy("greedy"), options, 0);
    leader.receive(1_rank, LoadReport{1, 0, 100, loads_of(4, 7, 10000)}, now);
    if (all) leader.receive(2_rank, LoadReport{1, 0, 100, {}}, now);
    return leader.think(now, {}, 100).planned;
  };
  CHECK(planned_at(1, true));
  CHECK(!planned_at(1, false));
  CHECK(!planned_at(0.9 * options.patience(), false));
  CHECK(planned_at(1.1 * options.patience(), false));
}

TEST_CASE("a look that comes to nothing is not repeated at once") {
  ControllerOptions options;
  options.gap = 1;
  Controller leader(0_rank, std::make_shared<Layout>(grid_layout(12, 1, 2)), make_policy("greedy"), options, 0);
  const auto planned_at = [&](double now) {
    const auto round = static_cast<std::uint32_t>(10 * now);
    leader.receive(1_rank, LoadReport{round, 0, 100, loads_of(6, 11, 1000)}, now);
    return leader.think(now, loads_of(0, 5, 1000), 100).planned;
  };
  CHECK(planned_at(1));
  CHECK(!planned_at(1.5));
  CHECK(planned_at(2.1));
}

TEST_CASE("what a plan moves does not move again while it is on its way, nor soon after it has come") {
  Controller leader = eager_leader();
  leader.receive(1_rank, LoadReport{1, 0, 100, loads_of(0, 19, 1000)}, 1);
  const Decision first = leader.think(1, {}, 100);  // 200 s of work: what has moved rests for 10 s
  const std::set<SubdomainId> moved = moved_by(first);
  REQUIRE(moved.size() == 10);
  Loads kept, come;
  for (const ReportedLoad& load : loads_of(0, 19, 1000)) (moved.contains(load.subdomain) ? come : kept).push_back(load);
  for (ReportedLoad& load : come) load.epoch = 1;

  SUBCASE("rank 1 has finished all that it kept, but not heard of the plan yet") {
    leader.receive(1_rank, LoadReport{2, 0, 100, {come[0]}}, 50);
    const Decision second = leader.think(50, {}, 100);
    CHECK(second.planned);
    for (const SubdomainId id : moved_by(second)) CHECK((id == come[0].subdomain || !moved.contains(id)));
  }
  SUBCASE("rank 1 has finished all that it kept, and all that moved has just come") {
    for (const ReportedLoad& load : come) leader.arrived(load.subdomain, 1);
    leader.receive(1_rank, LoadReport{2, 1, 100, {}}, 2);
    const Decision soon = leader.think(2, come, 100);
    CHECK(soon.planned);
    CHECK(moved_by(soon).empty());
    leader.receive(1_rank, LoadReport{3, 1, 100, {}}, 20);
    CHECK(!moved_by(leader.think(20, come, 100)).empty());
  }
}

TEST_CASE("what is on its way to a rank is not sent on before it has come, however long that takes") {
  ControllerOptions options = planning_early();
  options.interval = 1000, options.overhead = 1e9, options.gap = 0.01;
  Controller leader(0_rank, std::make_shared<Layout>(grid_layout(30, 1, 3)), make_policy("greedy"), options, 0);
  leader.receive(1_rank, LoadReport{1, 0, 100, loads_of(10, 29, 1000)}, 1);
  leader.receive(2_rank, LoadReport{1, 0, 100, {}}, 1);
  const auto first = sent<Plan>(leader.think(1, loads_of(0, 9, 1000), 100));
  REQUIRE(first.size() == 1);
  Loads come;
  for (const Move& move : first[0].second.moves) {
    CHECK(move.destination == 2_rank);
    come.push_back({move.subdomain, 1, 1000, 40});
  }
  REQUIRE(come.size() == 10);

  // Ranks 0 and 1 have finished all that they kept, long after what has moved last may move again.
  leader.receive(1_rank, LoadReport{2, 1, 100, {}}, 20);
  const Decision meanwhile = leader.think(20, {}, 100);
  CHECK(meanwhile.planned);
  CHECK(moved_by(meanwhile).empty());
  leader.receive(2_rank, LoadReport{2, 0, 100, come}, 21);
  CHECK(!moved_by(leader.think(21, {}, 100)).empty());
}

TEST_CASE("a policy learns what moves cost, and that what is done sooner than moved stays") {
  std::vector<LoadSnapshot> shown;
  const auto policy = leader_policy([&](const LoadSnapshot& load) {
    shown.push_back(load);
    return std::vector<Move>{};
  });
  Controller leader(0_rank, std::make_shared<Layout>(grid_layout(12, 1, 2)), policy, planning_early(), 0);
  Loads own = loads_of(6, 11, 1000);
  own[0].bytes = 0;
  own[1].bytes = 1000;
  own[2].bytes = 40'000;
  leader.receive(1_rank, LoadReport{1, 0, 100, own}, 1);
  static_cast<void>(leader.think(1, {}, 100));
  REQUIRE(shown.size() == 1);
  // A millisecond, a nanosecond for each byte, and at both ends the time in which a rank makes 0.015 triangles.
  CHECK(find(shown[0], 6_sub)->cost == doctest::Approx(0.001));
  CHECK(find(shown[0], 7_sub)->cost == doctest::Approx(0.001 + 1e-6 + 2 * 0.15));
  CHECK(find(shown[0], 8_sub)->cost == doctest::Approx(0.001 + 4e-5 + 2 * 6));
  CHECK(!find(shown[0], 7_sub)->fixed);
  CHECK(find(shown[0], 8_sub)->fixed);  // 10 s of work
}

TEST_CASE("plans are numbered") {
  Controller leader = eager_leader();
  leader.receive(1_rank, LoadReport{1, 0, 100, loads_of(0, 19, 1000)}, 1);
  const auto first = sent<Plan>(leader.think(1, {}, 100));
  REQUIRE(first.size() == 1);
  CHECK(first[0].second.round == 1);
  std::vector<ReportedLoad> more = loads_of(0, 19, 1000);
  for (ReportedLoad& load : more) load.remaining = 5000;
  leader.receive(1_rank, LoadReport{2, 1, 100, more}, 100);
  const auto second = sent<Plan>(leader.think(100, {}, 100));
  REQUIRE(second.size() == 1);
  CHECK(second[0].second.round == 2);
}

TEST_CASE("each neighbor hears of a rank once, and of its end, too") {
  Controller rank = controller_of(0_rank, grid_layout(5, 2, 2), "diffusion");  // each subdomain has a neighbor there
  const auto heard = [&](double now, const Loads& own) {
    std::vector<Rank> ranks;
    for (const auto& [to, report] : sent<LoadReport>(rank.think(now, own, 100))) ranks.push_back(to);
    return ranks;
  };
  CHECK(heard(1, loads_of(0, 4, 1000)) == std::vector<Rank>{1_rank});
  Controller far = controller_of(0_rank, grid_layout(80, 1, 16), "diffusion");
  const auto full = [&](double now, const Loads& own) {
    std::set<Rank> ranks;
    for (const auto& [to, report] : sent<LoadReport>(far.think(now, own, 100)))
      if (report.unlisted == 0 && report.round > 0) ranks.insert(to);
    return ranks;
  };
  CHECK(full(1, {{17_sub, 0, 1000, 40}}).contains(3_rank));  // no partner otherwise
  const auto last = sent<LoadReport>(far.think(11, {}, 100));
  std::vector<Rank> told;
  for (const auto& [to, report] : last) told.push_back(to);
  CHECK(std::ranges::count(told, 3_rank) == 1);
}

TEST_CASE("one rank at work makes no noise, and a rank without memory is not idle") {
  LoadSnapshot s = initial_snapshot(grid_layout(4, 1, 2), {100, 100});
  for (RankLoad& rank : s.ranks) rank.doubt = 0.5;
  CHECK(noise_of(s) > 0);
  s.ranks[1_rank].remaining = 0;
  CHECK(noise_of(s) == 0);
  s.ranks[1_rank].free_memory = 0;
  be_sure_of_idle_ranks(s);
  CHECK(s.ranks[0_rank].doubt == 0.5);
  s.ranks[1_rank].free_memory = 1;
  be_sure_of_idle_ranks(s);
  CHECK(s.ranks[0_rank].doubt == 0);
}

TEST_CASE("a rank that can be given nothing does not run out of work") {
  LoadSnapshot s = initial_snapshot(grid_layout(30, 1, 3), {100, 100, 100});
  for (SubdomainLoad& load : s.subdomains) load.owner = load.id < 20_sub ? 0_rank : 2_rank;
  sum_up(s);  // the second has nothing, the third half as much as the first
  CHECK(outlook(s, {}, 0, 1) == Verdict::kDone);
  s.ranks[1_rank].free_memory = 0;
  CHECK(outlook(s, {}, 0, 1) == Verdict::kTooEarly);
}

TEST_CASE("what is finished before it would have moved is fixed, and a plan must save what is required") {
  LoadSnapshot s = initial_snapshot(grid_layout(4, 1, 2), {100, 100});
  s.subdomains[0].bytes = 100'000;  // 15 s to pack, and again to unpack, for 10 s of work
  s.subdomains[1].bytes = 10'000;
  price_moves(s, {});
  CHECK(s.subdomains[0].fixed);
  CHECK(!s.subdomains[1].fixed);
  CHECK(s.subdomains[0].cost == doctest::Approx(30).epsilon(0.01));

  s = initial_snapshot(grid_layout(10, 1, 2), {100, 400});  // 50 s and 12.5 s: a move makes it 40 and 15
  const std::vector<Move> plan{{4_sub, 1_rank}};
  const auto worth = [&](double gain, double seconds) {
    return worth_moving(s, plan, {}, {.gain = gain, .seconds = seconds}).size();
  };
  CHECK(worth(0.19, 0) == 1);
  CHECK(worth(0.21, 0) == 0);
  CHECK(worth(0, 9.5) == 1);
  CHECK(worth(0, 10.5) == 0);
}
