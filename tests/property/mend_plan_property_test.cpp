// Plans made at random, as bad as can be, and what mending makes of them.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "balancer/planner/mend_plan.hpp"
#include "balancer/planner/within_memory.hpp"
#include "property/cases.hpp"
#include "support/load_snapshots.hpp"
#include "support/planned_moves.hpp"

using namespace driftmesh;
using namespace driftmesh::balancer;
using driftmesh::testing::check_valid;
using driftmesh::testing::memory_needed;
using driftmesh::testing::random_snapshot;
using driftmesh::testing::time_with;

namespace {

constexpr MoveCost kFree{.latency = 0, .bandwidth = 1e300, .pack_work = 0};

struct Case {
  LoadSnapshot snapshot;
  std::vector<Move> moves;
  double finish = 0;  ///< finishing time with the moves
};

Case random_case(std::mt19937_64& random) {
  Case c{random_snapshot(random), {}, 0};
  const auto fixed = random() % 3, moving = random() % 11;  // in tenths
  for (SubdomainLoad& s : c.snapshot.subdomains) {
    s.fixed = random() % 10 < fixed;
    const Rank to{static_cast<std::int32_t>(random() % c.snapshot.ranks.size())};
    if (!s.fixed && to != s.owner && random() % 10 < moving) c.moves.push_back({s.id, to});
  }
  const IdVector<Rank, double> needed = memory_needed(c.snapshot, c.moves);
  const bool scarce = random() % 2 == 0;
  for (const Rank r : ids_of(needed))
    if (scarce) c.snapshot.ranks[r].free_memory = needed[r] + static_cast<double>(random() % 2000);
  c.finish = time_with(c.snapshot, c.moves) * (1 + 1e-12);  // sums are rounded
  return c;
}

void check_possible(const Case& c, const std::vector<Move>& moves) {
  check_valid(c.snapshot, moves);
  const IdVector<Rank, double> needed = memory_needed(c.snapshot, moves);
  for (const Rank r : ids_of(needed)) REQUIRE(needed[r] <= c.snapshot.ranks[r].free_memory * (1 + 1e-12) + 1e-6);
}

double border(const Case& c, const std::vector<Move>& moves) {
  return border_between_ranks(after(c.snapshot, moves));
}

}  // namespace

TEST_CASE("a mended plan is valid, no later than it may be, and keeps to the number of moves") {
  auto random = testing::seeded_generator("mend plan");
  int fewer = 0, earlier = 0, shorter = 0;
  for (std::int64_t i = testing::case_count(1000); i > 0; --i) {
    const std::uint64_t seed = random();
    CAPTURE(seed);
    std::mt19937_64 one(seed);
    const Case c = random_case(one);
    const double latest = c.finish * std::uniform_real_distribution<double>(0.5, 1.5)(one);
    const double wanted = latest * std::uniform_real_distribution<double>(0.7, 1)(one);
    const std::size_t most = one() % (c.moves.size() + 1);
    const std::vector<Move> mended = mend_plan(c.snapshot, c.moves, kFree, {wanted, latest, most});
    check_possible(c, mended);
    const double finish = time_with(c.snapshot, mended);
    REQUIRE(finish <= std::max(latest, c.finish) * (1 + 1e-9));
    REQUIRE(mended == mend_plan(c.snapshot, c.moves, kFree, {wanted, latest, most}));
    earlier += latest < c.finish && finish <= latest;

    // With all the time in the world there need not be too many.
    const std::vector<Move> few = mend_plan(c.snapshot, c.moves, kFree, {HUGE_VAL, HUGE_VAL, most});
    check_possible(c, few);
    REQUIRE(few.size() <= most);
    fewer += few.size() < c.moves.size();

    // If it may be as it is, it leaves no more border and has no more moves.
    const std::vector<Move> all = mend_plan(c.snapshot, c.moves, kFree, {c.finish, c.finish, c.moves.size()});
    check_possible(c, all);
    REQUIRE(time_with(c.snapshot, all) <= c.finish * (1 + 1e-9));
    REQUIRE(all.size() <= c.moves.size());
    REQUIRE(border(c, all) <= border(c, c.moves) + 1e-9);
    shorter += border(c, all) < border(c, c.moves) - 1e-9;
  }
  std::printf("fewer moves %d, earlier %d, less border %d\n", fewer, earlier, shorter);
  CHECK(fewer > 0);
  CHECK(earlier > 0);
  CHECK(shorter > 0);
}

TEST_CASE("mending counts what moves cost") {
  auto random = testing::seeded_generator("cost of mended plans");
  for (std::int64_t i = testing::case_count(300); i > 0; --i) {
    const std::uint64_t seed = random();
    CAPTURE(seed);
    std::mt19937_64 one(seed);
    Case c = random_case(one);
    // finishing_times() leaves out moves that cost more than the work they move.
    for (SubdomainLoad& s : c.snapshot.subdomains) s.bytes = static_cast<std::uint64_t>(s.remaining);
    std::erase_if(c.moves, [&](const Move& move) { return find(c.snapshot, move.subdomain)->remaining < 1e-3; });
    for (RankLoad& rank : c.snapshot.ranks) rank.free_memory = kAmpleMemory;
    const MoveCost cost{.latency = 0.1, .bandwidth = 1e3, .pack_work = 0.2};
    const auto finish = [&](const std::vector<Move>& moves) {
      return std::ranges::max(finishing_times(c.snapshot, moves, cost));
    };
    const double latest = finish(c.moves);
    const std::vector<Move> mended = mend_plan(c.snapshot, c.moves, cost, {latest, latest, c.moves.size()});
    REQUIRE(finish(mended) <= latest * (1 + 1e-9));
  }
}

TEST_CASE("chains and cycles of moves become short, and parts stay compact") {
  // A strip on three ranks. Each has four; the first gives two to the second, which gives two to the third.
  const LoadSnapshot strip = testing::initial_snapshot(testing::grid_layout(12, 1, 3), {100, 100, 100});
  const std::vector<Move> cycle{{SubdomainId{0}, Rank{1}}, {SubdomainId{4}, Rank{2}}, {SubdomainId{8}, Rank{0}}};
  CHECK(mend_plan(strip, cycle, kFree, {40, 40, 3}).empty());

  LoadSnapshot lopsided = strip;
  for (SubdomainLoad& s : lopsided.subdomains)
    if (s.owner == Rank{2}) s.owner = Rank{to_int(s.id) < 10 ? 0 : 2};
  sum_up(lopsided);  // 6, 4 and 2
  const std::vector<Move> chain{
      {SubdomainId{2}, Rank{1}}, {SubdomainId{3}, Rank{1}}, {SubdomainId{6}, Rank{2}}, {SubdomainId{7}, Rank{2}}};
  const std::vector<Move> direct = mend_plan(lopsided, chain, kFree, {40, 40, 2});
  CHECK(direct.size() == 2);
  CHECK(time_with(lopsided, direct) == doctest::Approx(40));
  for (const Move& move : direct) CHECK(move.destination == Rank{2});
}

TEST_CASE("late ranks give what leaves no more border") {
  // Two ranks alternate on a strip. Nine of twelve at one of them are too many.
  Layout layout = testing::grid_layout(12, 1, 2);
  for (const SubdomainId s : ids_of(layout.subdomains)) layout.subdomains[s].owner = Rank{to_int(s) % 2};
  Case c{testing::initial_snapshot(std::move(layout), {100, 100}), {}, 0};
  for (const SubdomainLoad& s : c.snapshot.subdomains)
    if (const Rank to{to_int(s.id) < 9 ? 0 : 1}; to != s.owner) c.moves.push_back({s.id, to});
  const std::vector<Move> mended = mend_plan(c.snapshot, c.moves, kFree, {70, 70, 12});
  CHECK(time_with(c.snapshot, mended) == doctest::Approx(70));
  CHECK(border(c, mended) == doctest::Approx(1));
}

TEST_CASE("a rank that nobody can help is helped once others are no longer late") {
  // A strip on three ranks that have 6, 9 and 2 subdomains. The last has no memory except for these two, which the
  // first is to have. The second finishes after 90 s, and none of the others can take any: but those two return.
  LoadSnapshot strip = testing::initial_snapshot(testing::grid_layout(17, 1, 3), {100, 100, 100});
  for (SubdomainLoad& s : strip.subdomains) s.owner = Rank{to_int(s.id) < 6 ? 0 : to_int(s.id) < 15 ? 1 : 2};
  sum_up(strip);
  strip.ranks[Rank{2}].free_memory = 0;
  const std::vector<Move> worse{{SubdomainId{15}, Rank{0}}, {SubdomainId{16}, Rank{0}}};
  CHECK(time_with(strip, worse) == doctest::Approx(90));
  CHECK(time_with(strip, mend_plan(strip, worse, kFree, {75, 75, 17})) == doctest::Approx(80));
}

TEST_CASE("late ranks stay compact where nobody can finish in time") {
  // A strip on two ranks, the first with seven of twelve subdomains of about the same work. Exchanges could make times
  // very equal, and no rank early enough.
  auto random = testing::seeded_generator("late and compact");
  for (int i = 0; i < 100; ++i) {
    LoadSnapshot strip = testing::initial_snapshot(testing::grid_layout(12, 1, 2), {100, 100});
    for (SubdomainLoad& s : strip.subdomains) s.remaining = std::uniform_real_distribution<double>(950, 1050)(random);
    sum_up(strip);
    const std::vector<Move> seven{{SubdomainId{6}, Rank{0}}};
    const std::vector<Move> mended = mend_plan(strip, seven, kFree, {50, 50, 12});
    CHECK(border_between_ranks(after(strip, mended)) == doctest::Approx(1));
  }
}

TEST_CASE("borders become about as short as they can be, also where no single change saves any") {
  // A square of equal subdomains on four ranks, dealt out at random: quarters would leave a border of twice its side.
  auto random = testing::seeded_generator("short borders");
  constexpr int kSide = 12;
  double sum = 0;
  const std::int64_t cases = testing::case_count(50);
  for (std::int64_t i = cases; i > 0; --i) {
    Layout layout = testing::grid_layout(kSide, kSide, 4);
    std::vector<Rank> owners;
    for (const auto& s : layout.subdomains) owners.push_back(s.owner);
    std::ranges::shuffle(owners, random);
    for (const SubdomainId s : ids_of(layout.subdomains)) layout.subdomains[s].owner = owners[to_index(s)];
    Case c{testing::initial_snapshot(std::move(layout), {100, 100, 100, 100}), {}, 0};
    const double even = time_with(c.snapshot, {});
    const std::vector<Move> mended = mend_plan(c.snapshot, {}, kFree, {1.03 * even, 1.03 * even, SIZE_MAX});
    CHECK(time_with(c.snapshot, mended) <= 1.03 * even);
    sum += border(c, mended);
  }
  std::printf("mean border %.1f of at least %d\n", sum / static_cast<double>(cases), 2 * kSide);
  CHECK(sum <= 1.7 * 2 * kSide * static_cast<double>(cases));
}

TEST_CASE("what is in proportion to speeds within memory fits, and all work is done") {
  auto random = testing::seeded_generator("within memory");
  int slower = 0, fixed = 0;
  for (std::int64_t i = testing::case_count(1000); i > 0; --i) {
    const std::uint64_t seed = random();
    CAPTURE(seed);
    std::mt19937_64 one(seed);
    LoadSnapshot snapshot = random_snapshot(one);
    const IdVector<Rank, double> speeds = assumed_speeds(snapshot.ranks);
    CHECK(ideal_time(within_memory(snapshot)) == doctest::Approx(ideal_time(snapshot)));
    for (RankLoad& rank : snapshot.ranks)
      if (one() % 2 == 0) rank.free_memory = ideal_time(snapshot) * std::uniform_real_distribution<double>(0, 3)(one);
    const bool someone_has_plenty =
        std::ranges::any_of(snapshot.ranks, [](const RankLoad& rank) { return rank.free_memory == kAmpleMemory; });
    const LoadSnapshot possible = within_memory(snapshot);
    const double ideal = ideal_time(possible);
    REQUIRE(ideal >= ideal_time(snapshot) * (1 - 1e-9));
    for (const SubdomainLoad& s : possible.subdomains) {
      const bool is_short = possible.ranks[s.owner].speed < speeds[s.owner] * (1 - 1e-9);
      REQUIRE((s.fixed || !is_short));
      if (possible.ranks[s.owner].speed == speeds[s.owner]) REQUIRE(!s.fixed);
      fixed += s.fixed;
    }
    for (const Rank r : ids_of(speeds)) {
      REQUIRE(possible.ranks[r].speed <= speeds[r] * (1 + 1e-9));
      if (!someone_has_plenty) continue;
      const double share = ideal * possible.ranks[r].speed, has = snapshot.ranks[r].remaining;
      REQUIRE(share <= std::max(has, has + snapshot.ranks[r].free_memory) * (1 + 1e-9));
      if (possible.ranks[r].speed < speeds[r] * (1 - 1e-9)) {
        ++slower;
        REQUIRE(share >= (has + snapshot.ranks[r].free_memory) / 1.03 * (1 - 1e-9));
      }
    }
  }
  CHECK(slower > 0);
  CHECK(fixed > 0);
}
