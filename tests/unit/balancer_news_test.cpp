// What rank 0 takes from the news of all ranks, and shows to the policy.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>

#include "balancer/snapshot/rank_board.hpp"
#include "balancer/snapshot/rank_news.hpp"
#include "balancer/snapshot/situation.hpp"
#include "property/cases.hpp"
#include "support/id_literals.hpp"
#include "support/load_snapshots.hpp"

using namespace driftmesh;
using namespace driftmesh::balancer;
using namespace driftmesh::testing;

TEST_CASE("the subdomain in work is no spare, and each other one has its turn") {
  const std::vector<ReportedLoad> own{{7_sub, 2, 300, 40}, {3_sub, 0, 200, 50}, {5_sub, 1, 100, 60}};
  CHECK(news_of(4, {.own = own, .speed = 90, .doubt = 0.5, .free_memory = 800}, own) ==
        LoadNews{4, 600, 300, 90, 0.5, 800});
  CHECK(news_of(1, {}, {}) == LoadNews{1, 0, 0, 0, 0, kAmpleMemory});
  const std::vector<SubdomainLoad> states = states_of(2_rank, own);
  REQUIRE(states.size() == 3);
  const auto check = [&](std::size_t i, SubdomainId id, double remaining, std::uint64_t bytes, std::int32_t turn) {
    CHECK(states[i].id == id);
    CHECK(states[i].owner == 2_rank);
    CHECK(states[i].remaining == remaining);
    CHECK(states[i].bytes == bytes);
    CHECK(states[i].turn == turn);
  };
  check(0, 3_sub, 200, 50, 1);
  check(1, 5_sub, 100, 60, 2);
  check(2, 7_sub, 300, 40, 0);
}

TEST_CASE("news counts once, in its order, and from then on time passes at its speed") {
  RankNews news(grid_layout(6, 1, 3), 10);  // 2000 each
  CHECK(news.state(1_rank, 10).remaining == 2000);
  CHECK(news.state(1_rank, 30).remaining == 1980);  // nobody's speed is known: 1
  CHECK(!news.complete());
  CHECK(!news.hear(1_rank, {2, 500, 300, 100, 0.25, 900}, 20));
  CHECK(news.state(1_rank, 20).remaining == 500);
  CHECK(news.state(1_rank, 20).doubt == 0.25);
  CHECK(news.state(1_rank, 20).free_memory == 900);
  CHECK(news.state(1_rank, 22).remaining == 300);
  CHECK(news.state(1_rank, 99).remaining == 0);
  CHECK(news.state(2_rank, 22).remaining == 2000 - 12 * 100);  // at the only speed that is known
  for (const std::uint32_t old : {1U, 2U}) {
    CHECK(!news.hear(1_rank, {old, 9000, 9000, 7, 0, 1}, 20));
    CHECK(news.state(1_rank, 20).remaining == 500);
  }
  news.hear(1_rank, {3, 500, 300, 100, 0, 900}, 20);
  news.hear(1_rank, {4, 500, 300, 300, 0, 900}, 20);
  CHECK(news.known_or_mean(0) == 300);  // the last speed of each rank
  CHECK(!news.complete());
  news.hear(0_rank, {1, 100, 0, 100, 0, 900}, 20);
  CHECK(news.known_or_mean(0) == 200);
  CHECK(news.known_or_mean(50) == 50);
  CHECK(!news.complete());
  news.hear(2_rank, {1, 100, 0, 0, 0, 900}, 20);
  CHECK(news.complete());
  CHECK(news.known_or_mean(0) == 200);
}

TEST_CASE("more work than believed surprises where some of it can be given") {
  const auto surprises = [](double remaining, double spare) {
    RankNews news(grid_layout(4, 1, 2), 0);
    return news.hear(1_rank, {1, remaining, spare, 10, 0, 900}, 0);
  };
  CHECK(surprises(2200, 1));
  CHECK(!surprises(2200, 0));
  CHECK(!surprises(2050, 2050));
  CHECK(!surprises(1000, 1000));
}

TEST_CASE("a rank says how much memory it has when it asks, but its news says it better") {
  RankNews news(grid_layout(4, 1, 2), 0);
  news.hear_memory(1_rank, 700);
  CHECK(news.state(1_rank, 0).free_memory == 700);
  news.hear(1_rank, {1, 10, 10, 1, 0, 300}, 0);
  news.hear_memory(1_rank, 700);
  CHECK(news.state(1_rank, 0).free_memory == 300);
}

TEST_CASE("what is to move leaves one rank and comes to the other, which cannot give it yet, and needs memory for it") {
  RankNews news(grid_layout(4, 1, 2), 0);
  news.hear(0_rank, {1, 1000, 800, 10, 0, 500}, 0);
  news.hear(1_rank, {1, 100, 0, 10, 0, 600}, 0);
  news.expect(0_rank, 1_rank, 300, 5);
  const RankLoad giver = news.state(0_rank, 5), taker = news.state(1_rank, 5);
  CHECK(giver.remaining == 1000 - 50 - 300);
  CHECK(giver.free_memory == 800);
  CHECK(taker.remaining == 100 - 50 + 300);
  CHECK(taker.free_memory == 300);
  CHECK(news.can_give(0_rank, giver));
  CHECK(!news.can_give(1_rank, taker));
  news.expect(0_rank, 1_rank, 500, 5);  // all that it could give
  CHECK(!news.can_give(0_rank, news.state(0_rank, 5)));
  CHECK(news.state(1_rank, 5).free_memory == 0);  // and not less
  CHECK(news.state(0_rank, 15).remaining == 50);
}

TEST_CASE("a board agrees with one made anew, whatever is put on it") {
  std::mt19937_64 random = seeded_generator("rank boards");
  for (std::int64_t i = case_count(100); i > 0; --i) {
    const auto ranks = static_cast<std::int32_t>(1 + random() % 6);
    const auto layout = std::make_shared<const Layout>(grid_layout(ranks, 1, ranks));
    RankNews news(*layout, 0);
    const auto any_news = [&](std::uint32_t round) {
      const double work = random() % 3 == 0 ? 0 : static_cast<double>(random() % 1000);
      return LoadNews{round, work, random() % 2 == 0 ? 0 : work / 2, static_cast<double>(1 + random() % 9), 0, 900};
    };
    for (const Rank r : first_ids<Rank>(ranks)) news.hear(r, any_news(1), 0);
    RankBoard board(news, layout, 0);
    for (std::uint32_t round = 2; round < 12; ++round) {
      const auto r = static_cast<Rank>(random() % static_cast<std::uint64_t>(ranks));
      LoadNews next = any_news(round);
      next.speed = news.state(r, 0).speed;
      news.hear(r, next, 0);
      const RankLoad state = news.state(r, 0);
      board.put(r, state, news.can_give(r, state));

      double work = 0, speed = 0;
      std::size_t idle = 0, givers = 0;
      for (const Rank other : first_ids<Rank>(ranks)) {
        const RankLoad load = news.state(other, 0);
        work += load.remaining;
        speed += load.speed;
        idle += load.remaining <= 0;
        const bool able = news.can_give(other, load);
        givers += able;
        REQUIRE(board.able()[other] == able);
        REQUIRE(board.snapshot().ranks[other].remaining == load.remaining);
      }
      REQUIRE(board.ideal_time() == doctest::Approx(work / speed));
      const std::size_t others = idle == 0 ? 0 : idle - 1;
      REQUIRE(board.rivals() == (givers == 0 ? others : others / givers));
    }
  }
}
