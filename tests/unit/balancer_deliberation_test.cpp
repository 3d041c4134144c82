#include <doctest/doctest.h>

#include <algorithm>
#include <functional>

#include "balancer/cost/move_cost.hpp"
#include "balancer/snapshot/deliberation.hpp"
#include "balancer/trigger/outlook.hpp"
#include "protocol/packed_size.hpp"
#include "support/id_literals.hpp"
#include "support/load_snapshots.hpp"

using namespace driftmesh;
using namespace driftmesh::balancer;
using driftmesh::testing::grid_layout;
using driftmesh::testing::initial_snapshot;

namespace {

std::vector<Deliberation> noted_by(const std::function<void()>& plan) {
  DeliberationLog log;
  plan();
  return log.take();
}

Verdict verdict_on(const LoadSnapshot& snapshot, double cost_of_planning = 0) {
  const auto noted = noted_by([&] { static_cast<void>(outlook(snapshot, {}, cost_of_planning)); });
  REQUIRE(noted.size() == 1);
  CHECK(noted[0].subject == Deliberation::Subject::kLoad);
  CHECK(noted[0].finish == finishing_time(snapshot));
  CHECK(noted[0].ideal == ideal_time(snapshot));
  return noted[0].verdict;
}

Deliberation judged(const LoadSnapshot& snapshot, const std::vector<Move>& moves) {
  const auto noted = noted_by([&] { static_cast<void>(worth_moving(snapshot, moves, {})); });
  REQUIRE(noted.size() == 1);
  return noted[0];
}

}  // namespace

TEST_CASE("a look at the load says why nothing is planned") {
  LoadSnapshot s = initial_snapshot(grid_layout(10, 1, 2), {100, 100});
  CHECK(verdict_on(s) == Verdict::kEven);
  s.subdomains[0].remaining *= 1.01;
  sum_up(s);
  CHECK(verdict_on(s) == Verdict::kSmallGain);
  s.subdomains[0].remaining *= 10;
  sum_up(s);
  CHECK(verdict_on(s) == Verdict::kDone);
  CHECK(verdict_on(s, 1e6) == Verdict::kCostlyPlanning);
  for (RankLoad& rank : s.ranks) rank.doubt = 10;
  CHECK(verdict_on(s) == Verdict::kEven);  // as far as can be known
}

TEST_CASE("each move of a plan has its verdict") {
  LoadSnapshot s = initial_snapshot(grid_layout(12, 1, 2), {1e6, 4e6});
  for (SubdomainLoad& subdomain : s.subdomains) subdomain.remaining = 1e6;
  s.subdomains[1].fixed = true;
  s.subdomains[2].bytes = protocol::kMostPackedBytes + 1;
  s.subdomains[3].bytes = 100'000'000;  // 1.5 s to pack, for 1 s of work
  sum_up(s);
  s.ranks[1_rank].free_memory = 2.5e6;
  const Deliberation plan = judged(s, {{0_sub, 1_rank},
                                       {1_sub, 1_rank},
                                       {2_sub, 1_rank},
                                       {3_sub, 1_rank},
                                       {99_sub, 1_rank},
                                       {4_sub, 0_rank},
                                       {0_sub, 1_rank},
                                       {5_sub, 1_rank},
                                       {4_sub, 1_rank}});
  CHECK(plan.subject == Deliberation::Subject::kPlan);
  CHECK(plan.verdict == Verdict::kDone);
  CHECK(plan.saves > 0);
  const auto verdicts_of = [&](SubdomainId id) {
    std::vector<Verdict> found;
    for (const JudgedMove& move : plan.moves)
      if (move.subdomain == id) found.push_back(move.verdict);
    return found;
  };
  CHECK(verdicts_of(0_sub) == std::vector{Verdict::kInvalid, Verdict::kDone});
  CHECK(verdicts_of(1_sub) == std::vector{Verdict::kFixed});
  CHECK(verdicts_of(2_sub) == std::vector{Verdict::kTooLarge});
  CHECK(verdicts_of(3_sub) == std::vector{Verdict::kCostsMore});
  CHECK(verdicts_of(99_sub) == std::vector{Verdict::kInvalid});
  CHECK(verdicts_of(5_sub) == std::vector{Verdict::kDone});
  CHECK(verdicts_of(4_sub) == std::vector{Verdict::kInvalid, Verdict::kNoMemory});  // for two, but not for three
}

TEST_CASE("a plan that saves nothing, or has no moves, says so") {
  const LoadSnapshot s = initial_snapshot(grid_layout(10, 1, 2), {100, 100});
  CHECK(judged(s, {{0_sub, 1_rank}}).verdict == Verdict::kSmallSaving);
  CHECK(judged(s, {}).verdict == Verdict::kNoMoves);
  LoadSnapshot uneven = s;
  for (const std::size_t i : {6, 7, 8, 9}) uneven.subdomains[i].remaining = 0;
  sum_up(uneven);
  const Deliberation plan = judged(uneven, {{0_sub, 1_rank}, {1_sub, 1_rank}, {2_sub, 1_rank}});
  CHECK(plan.verdict == Verdict::kDone);
  CHECK(std::ranges::count(plan.moves, Verdict::kNeedless, &JudgedMove::verdict) > 0);
}

TEST_CASE("what is noted goes to the innermost log, or nowhere") {
  CHECK(!is_logged());
  note({.saves = 1});
  note_comparison(0, 5, false);
  DeliberationLog outer;
  note({.subject = Deliberation::Subject::kPlan, .saves = 2});
  {
    DeliberationLog inner;
    note({.saves = 3});
    CHECK(inner.take().size() == 1);
  }
  note({.subject = Deliberation::Subject::kPlan, .verdict = Verdict::kSmallSaving, .saves = 4});
  note_comparison(1, 6, false);
  note_comparison(0, 7, false);  // the moves were not worth it anyway
  const auto noted = outer.take();
  REQUIRE(noted.size() == 2);
  CHECK(noted[0].verdict == Verdict::kOtherPlan);
  CHECK(noted[0].border == 6);
  CHECK(noted[1].verdict == Verdict::kSmallSaving);
  CHECK(noted[1].border == 7);
}
