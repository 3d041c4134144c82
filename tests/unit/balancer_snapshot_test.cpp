#include <doctest/doctest.h>

#include "balancer/cost/move_cost.hpp"
#include "balancer/planner/remap_parts.hpp"
#include "balancer/planner/surplus.hpp"
#include "balancer/snapshot/speed_estimate.hpp"
#include "protocol/packed_size.hpp"
#include "support/id_literals.hpp"
#include "support/load_snapshots.hpp"

using namespace driftmesh;
using namespace driftmesh::balancer;
using driftmesh::testing::grid_layout;
using driftmesh::testing::initial_snapshot;

namespace {

std::vector<Part> parts_of(std::initializer_list<std::int32_t> numbers) {
  std::vector<Part> parts;
  for (const std::int32_t n : numbers) parts.push_back(Part{n});
  return parts;
}

std::vector<Rank> ranks_of(std::initializer_list<std::int32_t> numbers) {
  std::vector<Rank> ranks;
  for (const std::int32_t n : numbers) ranks.push_back(Rank{n});
  return ranks;
}

}  // namespace

TEST_CASE("the finishing time is that of the slowest rank for its work") {
  const LoadSnapshot s = initial_snapshot(grid_layout(8, 1, 2), {1000, 250});
  CHECK(finishing_time(s) == 16);
  CHECK(ideal_time(s) == 8000.0 / 1250);
  const LoadSnapshot better = after(s, std::vector<Move>{{4_sub, 0_rank}, {5_sub, 0_rank}});
  CHECK(finishing_time(better) == 8);
  CHECK(moves_between(s, better) == std::vector<Move>{{4_sub, 0_rank}, {5_sub, 0_rank}});
}

TEST_CASE("unknown and impossible speeds count as the mean of the others") {
  IdVector<Rank, RankLoad> ranks(4);
  CHECK(assumed_speeds(ranks) == IdVector<Rank, double>{1, 1, 1, 1});
  ranks[1_rank].speed = 100;
  ranks[2_rank].speed = 300;
  ranks[3_rank].speed = -5;
  CHECK(assumed_speeds(ranks) == IdVector<Rank, double>{200, 100, 300, 200});
  CHECK(finishing_time(LoadSnapshot{}) == 0);
  CHECK(ideal_time(LoadSnapshot{}) == 0);
}

TEST_CASE("subdomains are found by number, if they are listed") {
  LoadSnapshot s = initial_snapshot(grid_layout(5, 1, 1), {1});
  s.subdomains.erase(s.subdomains.begin() + 2);
  CHECK(find(s, 3_sub)->id == 3_sub);
  CHECK(find(s, 2_sub) == nullptr);
  CHECK(find(s, 9_sub) == nullptr);
}

TEST_CASE("a subdomain needs memory for what it has and what it will have") {
  CHECK(memory_for({.bytes = 30 * protocol::kBytesPerTriangle}) == 30);
  CHECK(memory_for({.remaining = 12}) == 12);
  CHECK(memory_for({.remaining = 12, .bytes = 30 * protocol::kBytesPerTriangle}) == 42);
}

TEST_CASE("light subdomains leave first, then those whose turn is last, then those with most work") {
  const SubdomainLoad one{.id = 5_sub, .remaining = 100, .bytes = 3 << 16, .turn = 4};
  const auto check = [&](const auto& change) {
    SubdomainLoad earlier = one;
    change(earlier);
    CHECK(leaves_before(earlier, one));
    CHECK(!leaves_before(one, earlier));
  };
  check([](SubdomainLoad& s) { s = {.id = 9_sub, .remaining = 1, .bytes = 2 << 16, .turn = 0}; });
  check([](SubdomainLoad& s) { s = {.id = 9_sub, .remaining = 1, .bytes = (3 << 16) + 9, .turn = 5}; });
  check([](SubdomainLoad& s) { s.id = 9_sub, s.remaining = 101; });
  check([](SubdomainLoad& s) { s.id = 4_sub; });
  CHECK(!leaves_before(one, one));
}

TEST_CASE("a speed is known after a while, and adapts") {
  SpeedEstimate speed(2);
  CHECK(speed.value() == 0);
  speed.add({10, 0.001});
  CHECK(speed.value() == 0);
  for (int i = 0; i < 1000; ++i) speed.add({100, 0.01});
  CHECK(speed.value() == doctest::Approx(10'000));
  for (int i = 0; i < 200; ++i) speed.add({50, 0.01});  // one averaging period at half the speed
  CHECK(speed.value() == doctest::Approx(5000 + 5000 * std::exp(-1)).epsilon(0.01));
  speed.add({1e9, 0});
  CHECK(speed.value() < 10'000);
}

TEST_CASE("starts of subdomains lower a speed evenly, and not only while they last") {
  // 1,000 triangles, of which the start makes none and takes as long as 100 others; in slices of 20.
  const auto after = [](double speed, double subdomains) {
    SpeedEstimate estimate;
    double least = 1e9, most = 0;
    for (double made = 0; made < 1000 * subdomains; made += 20) {
      if (std::fmod(made, 1000) == 0) estimate.add({0, 100 / speed, 1000});
      estimate.add({20, 20 / speed});
      if (made < 100) continue;
      least = std::min(least, estimate.value());
      most = std::max(most, estimate.value());
    }
    return std::pair(least, most);
  };
  for (const double subdomains : {0.5, 1.0, 7.3})
    for (const double speed : {500.0, 1000.0, 5000.0}) {
      CAPTURE(subdomains);
      CAPTURE(speed);
      const auto [least, most] = after(speed, subdomains);
      CHECK(least > 0.99 * speed / 1.1);
      CHECK(most < 1.01 * speed / 1.1);
    }
}

TEST_CASE("the start of a subdomain alone does not determine a speed") {
  SpeedEstimate estimate;
  estimate.add({0, 0.5, 1000});
  CHECK(estimate.value() == 0);
  estimate.add({1, 0.001});
  CHECK(estimate.value() == 0);
}

TEST_CASE("subdomains that are made in the slice that starts them determine a speed") {
  SpeedEstimate estimate;
  for (int i = 0; i < 100; ++i) estimate.add({50, 0.01, 50});
  CHECK(estimate.value() == doctest::Approx(5000));
}

TEST_CASE("surplus goes to the rank that finishes it first") {
  // The second rank is four times as fast: 8 of 10 subdomains are its share.
  const LoadSnapshot s = initial_snapshot(grid_layout(10, 1, 2), {100, 400});
  const LoadSnapshot dealt = deal_surplus(s, 0.02);
  CHECK(finishing_time(dealt) == 20);
  CHECK(moves_between(s, dealt).size() == 3);
  CHECK(moves_between(dealt, deal_surplus(dealt, 0.02)).empty());
}

TEST_CASE("neighbors go to a rank together unless all would then end too late") {
  // A row of five, all on the first of three ranks: 10 s for each. The first piece stays. From the end of the row on,
  // the others leave with their neighbors in 9 and 11 s, or one by one in 10 and 10.
  LoadSnapshot s = initial_snapshot(grid_layout(5, 1, 1), {100, 100, 100});
  const double work[] = {1000, 600, 500, 500, 400};
  Layout layout = *s.layout;
  layout.ranks = 3;
  for (SubdomainLoad& load : s.subdomains)
    layout.subdomains[load.id].predicted = load.remaining = work[to_index(load.id)];
  s.layout = std::make_shared<Layout>(layout);
  sum_up(s);
  const auto dealt = [&](double tolerance) { return moves_between(s, deal_surplus(s, tolerance)); };
  CHECK(dealt(0.12) == std::vector<Move>{{1_sub, 2_rank}, {2_sub, 2_rank}, {3_sub, 1_rank}, {4_sub, 1_rank}});
  CHECK(dealt(0.02) == std::vector<Move>{{1_sub, 1_rank}, {2_sub, 2_rank}, {3_sub, 2_rank}, {4_sub, 1_rank}});
}

TEST_CASE("borders of which one side is mostly finished do not count") {
  LoadSnapshot s = initial_snapshot(grid_layout(12, 1, 3), {100, 100, 100});
  CHECK(border_between_ranks(s) == 2);
  for (const double left : {499.0, 500.0, 501.0}) {  // out of 1000: a border is open until half is done on one side
    s.subdomains[3].remaining = left;
    CHECK(is_open_border(s, s.subdomains[3], s.subdomains[4]) == (left >= 500));
  }
  s.subdomains[3].remaining = 400;
  CHECK(!is_open_border(s, s.subdomains[3], s.subdomains[4]));
  CHECK(!is_open_border(s, s.subdomains[4], s.subdomains[3]));
  CHECK(is_open_border(s, s.subdomains[4], s.subdomains[5]));
  CHECK(border_between_ranks(s) == 1);
  // What leaves rank 0 has nothing in common with its neighbor on rank 1 any more, and goes where there is most room.
  for (const std::size_t i : {0, 1, 2, 3}) s.subdomains[i].remaining = 400;
  s.subdomains[4].remaining = 500;
  s.subdomains[8].remaining = 100;
  std::erase_if(s.subdomains, [](const SubdomainLoad& l) { return l.id > 4_sub && l.id != 8_sub; });
  sum_up(s);
  CHECK(find(deal_surplus(s, 0.02), 3_sub)->owner == 2_rank);
}

TEST_CASE("parts go to the ranks that hold most of their work") {
  const LoadSnapshot s = initial_snapshot(grid_layout(9, 1, 3), {100, 100, 100});
  const std::vector<Part> parts = parts_of({2, 2, 2, 0, 0, 0, 1, 1, 1});
  CHECK(remap_parts(s, parts, 0.02) == ranks_of({0, 0, 0, 1, 1, 1, 2, 2, 2}));
}

TEST_CASE("a part that is too large for a slow rank does not go to it") {
  const LoadSnapshot s = initial_snapshot(grid_layout(10, 1, 2), {100, 400});
  // Part 1, of 8 subdomains, holds all that rank 0 has; rank 0 is too slow for it.
  CHECK(remap_parts(s, parts_of({1, 1, 1, 1, 1, 1, 1, 1, 0, 0}), 0.02) == ranks_of({1, 1, 1, 1, 1, 1, 1, 1, 0, 0}));
}

TEST_CASE("moves without gain are not worth making") {
  const LoadSnapshot s = initial_snapshot(grid_layout(10, 1, 2), {100, 100});
  CHECK(worth_moving(s, std::vector<Move>{{0_sub, 1_rank}}, {}).empty());                   // makes it worse
  CHECK(worth_moving(s, std::vector<Move>{{0_sub, 1_rank}, {9_sub, 0_rank}}, {}).empty());  // an exchange
  CHECK(worth_moving(s, std::vector<Move>{}, {}).empty());
}

TEST_CASE("invalid moves are left out") {
  const LoadSnapshot s = initial_snapshot(grid_layout(10, 1, 2), {100, 400});
  const std::vector<Move> plan{{0_sub, 1_rank}, {0_sub, 1_rank},   {1_sub, 0_rank}, {99_sub, 1_rank},
                               {2_sub, 7_rank}, {3_sub, Rank{-1}}, {4_sub, 1_rank}, {5_sub, 1_rank}};
  CHECK(worth_moving(s, plan, {}) == std::vector<Move>{{0_sub, 1_rank}, {4_sub, 1_rank}});
}

TEST_CASE("subdomains that cost more to move than to finish stay") {
  LoadSnapshot s = initial_snapshot(grid_layout(4, 1, 2), {1000, 1000});
  s.subdomains[2].remaining = s.subdomains[3].remaining = 0;
  sum_up(s);
  const std::vector<Move> plan{{0_sub, 1_rank}};
  CHECK(worth_moving(s, plan, {}) == plan);
  // In the time to pack a byte, these ranks make 0.015 triangles.
  s.subdomains[0].bytes = 80'000;  // 1.2 s to pack, for 1 s of work
  CHECK(worth_moving(s, plan, {}).empty());
  s.subdomains[0].bytes = 70'000;  // 1.05 s to unpack; the other one would finish after 2.05 s instead of 2 s
  CHECK(worth_moving(s, plan, {}).empty());
}

TEST_CASE("subdomains too large for a message stay, whatever the gain") {
  LoadSnapshot s = initial_snapshot(grid_layout(10, 1, 2), {1e6, 1e6});
  for (SubdomainLoad& subdomain : s.subdomains) subdomain.remaining = subdomain.owner == 0_rank ? 1e12 : 0;
  sum_up(s);
  const std::vector<Move> plan{{0_sub, 1_rank}, {1_sub, 1_rank}};
  CHECK(worth_moving(s, plan, {}) == plan);
  s.subdomains[0].bytes = protocol::kMostPackedBytes + 1;
  CHECK(worth_moving(s, plan, {}) == std::vector<Move>{{1_sub, 1_rank}});
}

TEST_CASE("packing that is cheap on a fast rank is costly on a slow one") {
  const auto moves = [](double speed) {
    LoadSnapshot s = initial_snapshot(grid_layout(4, 1, 2), {speed, speed});
    for (SubdomainLoad& subdomain : s.subdomains) subdomain.remaining *= speed / 1000, subdomain.bytes = 1'000'000;
    s.subdomains[2].remaining = s.subdomains[3].remaining = 0;
    sum_up(s);
    return worth_moving(s, std::vector<Move>{{0_sub, 1_rank}}, {}).size();
  };
  CHECK(moves(1e6) == 1);  // 1 s of work either way
  CHECK(moves(1e3) == 0);
}

TEST_CASE("of moves that are not needed, the costly ones are dropped") {
  LoadSnapshot s = initial_snapshot(grid_layout(6, 1, 3), {1000, 1000, 1000});
  s.subdomains[1].remaining = 100;
  s.subdomains[1].bytes = 5'000;
  s.subdomains[4].remaining = s.subdomains[5].remaining = 0;
  s.subdomains[2].remaining = 2000;
  sum_up(s);
  // Rank 1 has 3 s of work, the others 1.1 and 0. Moving the small heavy one as well gains nothing.
  CHECK(worth_moving(s, std::vector<Move>{{1_sub, 2_rank}, {3_sub, 2_rank}}, {}) == std::vector<Move>{{3_sub, 2_rank}});
}

TEST_CASE("a plan saves what the moves that are made of it save") {
  LoadSnapshot s = initial_snapshot(grid_layout(6, 1, 2), {1000, 1000});
  s.subdomains[0].remaining = 10'000;
  s.subdomains[1].remaining = 3'000;
  for (const std::size_t i : {3, 4, 5}) s.subdomains[i].remaining = 0;
  sum_up(s);
  // Both moves end after 13 s instead of 14; the large one alone, after 10.
  const std::vector<Move> plan{{0_sub, 1_rank}, {1_sub, 1_rank}};
  const auto made = [&](double gain) { return worth_moving(s, plan, {}, {.gain = gain}); };
  CHECK(made(0.28) == std::vector<Move>{{0_sub, 1_rank}});
  CHECK(made(0.29).empty());
}
