#include <doctest/doctest.h>

#include "balancer/move_cost.hpp"
#include "balancer/remap_parts.hpp"
#include "balancer/speed_estimate.hpp"
#include "balancer/surplus.hpp"
#include "protocol/messages.hpp"
#include "support/load_snapshots.hpp"

using namespace driftmesh;
using namespace driftmesh::balancer;
using driftmesh::testing::grid_layout;
using driftmesh::testing::initial_snapshot;

TEST_CASE("the finishing time is that of the slowest rank for its work") {
  const LoadSnapshot s = initial_snapshot(grid_layout(8, 1, 2), {1000, 250});
  CHECK(finishing_time(s) == 16);
  CHECK(ideal_time(s) == 8000.0 / 1250);
  const LoadSnapshot better = after(s, std::vector<Move>{{4, 0}, {5, 0}});
  CHECK(finishing_time(better) == 8);
  CHECK(moves_between(s, better) == std::vector<Move>{{4, 0}, {5, 0}});
}

TEST_CASE("unknown and impossible speeds count as the mean of the others") {
  std::vector<RankState> ranks(4);
  CHECK(assumed_speeds(ranks) == std::vector<double>{1, 1, 1, 1});
  ranks[1].speed = 100;
  ranks[2].speed = 300;
  ranks[3].speed = -5;
  CHECK(assumed_speeds(ranks) == std::vector<double>{200, 100, 300, 200});
  CHECK(finishing_time(LoadSnapshot{}) == 0);
  CHECK(ideal_time(LoadSnapshot{}) == 0);
}

TEST_CASE("subdomains are found by number, if they are listed") {
  LoadSnapshot s = initial_snapshot(grid_layout(5, 1, 1), {1});
  s.subdomains.erase(s.subdomains.begin() + 2);
  CHECK(find(s, 3)->id == 3);
  CHECK(find(s, 2) == nullptr);
  CHECK(find(s, 9) == nullptr);
}

TEST_CASE("a speed is known after a while, and follows what happens") {
  SpeedEstimate speed(2);
  CHECK(speed.value() == 0);
  speed.add({10, 0.001});
  CHECK(speed.value() == 0);
  for (int i = 0; i < 1000; ++i) speed.add({100, 0.01});
  CHECK(speed.value() == doctest::Approx(10'000));
  for (int i = 0; i < 200; ++i) speed.add({50, 0.01});  // one memory's time at half the speed
  CHECK(speed.value() == doctest::Approx(5000 + 5000 * std::exp(-1)).epsilon(0.01));
  speed.add({1e9, 0});
  CHECK(speed.value() < 10'000);
}

TEST_CASE("the beginning of a subdomain alone does not tell a speed") {
  // Beginning takes 30 ms of a rank of 1,000 triangles a second, 60 ms of one half as fast; then a point makes two.
  const auto after = [](double speed, double seconds, bool finished) {
    SpeedEstimate estimate;
    estimate.add({0, 30 / speed, true, false});
    for (double at = 30 / speed; at < seconds; at += 2 / speed) estimate.add({2, 2 / speed});
    if (finished) estimate.add({2, 2 / speed, false, true});
    return estimate.value();
  };
  CHECK(after(1000, 0.2, false) == 0);
  CHECK(after(500, 0.2, false) == 0);
  CHECK(after(1000, 0.4, false) == doctest::Approx(1000).epsilon(0.1));
  CHECK(after(500, 0.8, false) == doctest::Approx(500).epsilon(0.1));
  // What was finished tells it, however much of the time the beginning took.
  CHECK(after(1000, 0.2, true) / after(500, 0.4, true) == doctest::Approx(2).epsilon(0.02));
}

TEST_CASE("surplus goes to who finishes it first") {
  // The second rank is four times as fast: 8 of 10 subdomains are its share.
  const LoadSnapshot s = initial_snapshot(grid_layout(10, 1, 2), {100, 400});
  const LoadSnapshot dealt = deal_surplus(s, 0.02);
  CHECK(finishing_time(dealt) == 20);
  CHECK(moves_between(s, dealt).size() == 3);
  CHECK(moves_between(dealt, deal_surplus(dealt, 0.02)).empty());
}

TEST_CASE("parts go to the ranks that hold most of their work") {
  const LoadSnapshot s = initial_snapshot(grid_layout(9, 1, 3), {100, 100, 100});
  const std::vector<Rank> parts{2, 2, 2, 0, 0, 0, 1, 1, 1};
  CHECK(remap_parts(s, parts, 0.02) == std::vector<Rank>{0, 0, 0, 1, 1, 1, 2, 2, 2});
}

TEST_CASE("a part that is too large for a slow rank does not go there") {
  const LoadSnapshot s = initial_snapshot(grid_layout(10, 1, 2), {100, 400});
  // Part 1, of 8 subdomains, holds all that rank 0 has; rank 0 is too slow for it.
  const std::vector<Rank> parts{1, 1, 1, 1, 1, 1, 1, 1, 0, 0};
  CHECK(remap_parts(s, parts, 0.02) == parts);
}

TEST_CASE("moves that gain nothing are not worth making") {
  const LoadSnapshot s = initial_snapshot(grid_layout(10, 1, 2), {100, 100});
  CHECK(worth_moving(s, std::vector<Move>{{0, 1}}, {}).empty());          // makes it worse
  CHECK(worth_moving(s, std::vector<Move>{{0, 1}, {9, 0}}, {}).empty());  // an exchange
  CHECK(worth_moving(s, std::vector<Move>{}, {}).empty());
}

TEST_CASE("moves that are not valid are left out") {
  const LoadSnapshot s = initial_snapshot(grid_layout(10, 1, 2), {100, 400});
  const std::vector<Move> plan{{0, 1}, {0, 1}, {1, 0}, {99, 1}, {2, 7}, {3, -1}, {4, 1}, {5, 1}};
  CHECK(worth_moving(s, plan, {}) == std::vector<Move>{{0, 1}, {4, 1}});
}

TEST_CASE("what costs more to move than to finish stays") {
  LoadSnapshot s = initial_snapshot(grid_layout(4, 1, 2), {1000, 1000});
  s.subdomains[2].remaining = s.subdomains[3].remaining = 0;
  sum_up(s);
  const std::vector<Move> plan{{0, 1}};
  CHECK(worth_moving(s, plan, {}) == plan);
  // In the time that a byte takes to pack these ranks make 0.015 triangles.
  s.subdomains[0].bytes = 80'000;  // 1.2 s to pack, for 1 s of work
  CHECK(worth_moving(s, plan, {}).empty());
  s.subdomains[0].bytes = 70'000;  // 1.05 s to unpack; the other one would finish after 2.05 s instead of 2 s
  CHECK(worth_moving(s, plan, {}).empty());
}

TEST_CASE("what one message cannot carry stays, however much there is to gain") {
  LoadSnapshot s = initial_snapshot(grid_layout(10, 1, 2), {1e6, 1e6});
  for (SubdomainState& subdomain : s.subdomains) subdomain.remaining = subdomain.owner == 0 ? 1e12 : 0;
  sum_up(s);
  const std::vector<Move> plan{{0, 1}, {1, 1}};
  CHECK(worth_moving(s, plan, {}) == plan);
  s.subdomains[0].bytes = protocol::kMostPackedBytes + 1;
  CHECK(worth_moving(s, plan, {}) == std::vector<Move>{{1, 1}});
}

TEST_CASE("a rank keeps what it can in its spare time, and first what is dear to move") {
  LoadSnapshot s = initial_snapshot(grid_layout(6, 1, 2), {1000, 1000});
  s.subdomains[1].bytes = 5'000;
  const std::vector<Move> plan{{0, 1}, {1, 1}, {2, 1}};
  CHECK(needed_moves(s, plan, {}, 0, 0.5) == plan);  // each is a second of work
  CHECK(needed_moves(s, plan, {}, 0, 1.1) == std::vector<Move>{{0, 1}, {2, 1}});
  CHECK(needed_moves(s, plan, {}, 0, 5).empty());
}

TEST_CASE("what a fast rank packs in no time is dear on a slow one") {
  const auto moves = [](double speed) {
    LoadSnapshot s = initial_snapshot(grid_layout(4, 1, 2), {speed, speed});
    for (SubdomainState& subdomain : s.subdomains) subdomain.remaining *= speed / 1000, subdomain.bytes = 1'000'000;
    s.subdomains[2].remaining = s.subdomains[3].remaining = 0;
    sum_up(s);
    return worth_moving(s, std::vector<Move>{{0, 1}}, {}).size();
  };
  CHECK(moves(1e6) == 1);  // 1 s of work either way
  CHECK(moves(1e3) == 0);
}

TEST_CASE("of moves that are not needed the dear ones are dropped") {
  LoadSnapshot s = initial_snapshot(grid_layout(6, 1, 3), {1000, 1000, 1000});
  s.subdomains[1].remaining = 100;
  s.subdomains[1].bytes = 5'000;
  s.subdomains[4].remaining = s.subdomains[5].remaining = 0;
  s.subdomains[2].remaining = 2000;
  sum_up(s);
  // Rank 1 has 3 s of work, the others 1.1 and 0. Moving the small heavy one as well gains nothing.
  CHECK(worth_moving(s, std::vector<Move>{{1, 2}, {3, 2}}, {}) == std::vector<Move>{{3, 2}});
}
