// When a leader asks for a whole plan, and when it is content with single moves.
#include <doctest/doctest.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include "balancer/snapshot/effort.hpp"
#include "controller_fixture.hpp"

using namespace driftmesh;
using namespace driftmesh::balancer;
using namespace driftmesh::testing;

namespace {

/// The first that may move, to the other of two ranks.
std::vector<Move> first_of(const LoadSnapshot& snapshot) {
  const auto first = std::ranges::find(snapshot.subdomains, false, &SubdomainLoad::fixed);
  return {{first->id, Rank{1 - to_int(first->owner)}}};
}

/// Plans of which each takes as long as it says, and single moves instead, which are the same if there are any.
class SlowPlans final : public Policy {
 public:
  struct Asked {
    int plans = 0, touch_ups = 0;
  };
  SlowPlans(double seconds, bool has_moves, Asked& asked) : seconds_(seconds), has_moves_(has_moves), asked_(asked) {}
  [[nodiscard]] Placement placement() const override { return Placement::kLeader; }
  [[nodiscard]] std::vector<Move> plan(const LoadSnapshot& snapshot, Rank) const override {
    ++asked_.plans;
    return first_of(snapshot);
  }
  [[nodiscard]] std::optional<std::vector<Move>> touch_up(const LoadSnapshot& snapshot) const override {
    ++asked_.touch_ups;
    return has_moves_ ? first_of(snapshot) : std::vector<Move>{};
  }
  [[nodiscard]] double planning_seconds(const LoadSnapshot&) const override { return seconds_; }

 private:
  double seconds_;
  bool has_moves_;
  Asked& asked_;
};

/// What a policy is asked in ten looks, a second apart, at a rank with all the work and one with none: at least 5 s can
/// be gained.
SlowPlans::Asked asked_in_ten_looks(double expected, double taken, bool has_moves = true, double overhead = 0.01) {
  SlowPlans::Asked asked;
  ControllerOptions options;
  options.reference_speed = 100;  // as fast as these ranks
  options.overhead = overhead;
  Controller leader(0_rank, std::make_shared<Layout>(grid_layout(40, 1, 2)),
                    std::make_shared<SlowPlans>(expected, has_moves, asked), options, 0);
  for (int i = 1; i <= 10; ++i) {
    leader.receive(1_rank, LoadReport{static_cast<std::uint32_t>(i), 0, 100, {}}, i);
    const int plans = asked.plans;
    if (leader.think(i, loads_of(0, 39, 50), 100).planned) leader.took(asked.plans > plans ? taken : 1e-6);
  }
  return asked;
}

}  // namespace

TEST_CASE("a plan that would take longer than it gains is not made, and single moves are") {
  const SlowPlans::Asked cheap = asked_in_ten_looks(1e-3, 1e-3);
  CHECK(cheap.plans == 10);
  const SlowPlans::Asked costly = asked_in_ten_looks(11, 11);
  CHECK(costly.plans == 0);
  CHECK(costly.touch_ups == 10);
  const SlowPlans::Asked unexpected = asked_in_ten_looks(1e-3, 11);  // it is known after the first
  CHECK(unexpected.plans == 1);
  CHECK(unexpected.touch_ups == 10);
  CHECK(asked_in_ten_looks(2, 2).plans == 0);              // less than it gains, but more than an eighth of the time
  CHECK(asked_in_ten_looks(1e-3, 2, true, 1).plans == 1);  // which is known after the first
  CHECK(asked_in_ten_looks(1e-3, 1e-3, true, 1).plans == 10);
  const SlowPlans::Asked seldom = asked_in_ten_looks(0.04, 0.04);  // a hundredth of the time, so every fourth second
  CHECK(seldom.plans == 3);
  CHECK(seldom.touch_ups == 10);
}

TEST_CASE("where no single move is worth making, a whole plan is not asked for") {
  const SlowPlans::Asked nothing = asked_in_ten_looks(1e-3, 1e-3, false);
  CHECK(nothing.touch_ups == 10);
  CHECK(nothing.plans == 0);
}

namespace {

/// A whole plan and single moves, both as given.
class TwoPlans final : public Policy {
 public:
  TwoPlans(std::vector<Move> whole, std::vector<Move> single, double most_moves)
      : whole_(std::move(whole)), single_(std::move(single)), most_moves_(most_moves) {}
  [[nodiscard]] Placement placement() const override { return Placement::kLeader; }
  [[nodiscard]] std::vector<Move> plan(const LoadSnapshot&, Rank) const override { return whole_; }
  [[nodiscard]] std::optional<std::vector<Move>> touch_up(const LoadSnapshot&) const override { return single_; }
  [[nodiscard]] double most_moves() const override { return most_moves_; }

 private:
  std::vector<Move> whole_, single_;
  double most_moves_;
};

/// The moves that a leader with eight subdomains makes or advises when the other rank has four.
std::vector<Move> moves_of_leader(const std::vector<Move>& whole, const std::vector<Move>& single, double most_moves) {
  Controller leader(0_rank, std::make_shared<Layout>(grid_layout(12, 1, 2)),
                    std::make_shared<TwoPlans>(whole, single, most_moves), planning_early(), 0);
  leader.receive(1_rank, LoadReport{1, 0, 100, loads_of(8, 11, 1000)}, 1);
  const Decision decision = leader.think(1, loads_of(0, 7, 1000), 100);
  std::vector<Move> moves = decision.moves;
  for (const auto& [to, plan] : sent<balancer::Plan>(decision))
    moves.insert(moves.end(), plan.moves.begin(), plan.moves.end());
  return moves;
}

std::size_t moves_made(const std::vector<Move>& whole, const std::vector<Move>& single, double most_moves) {
  return moves_of_leader(whole, single, most_moves).size();
}

}  // namespace

TEST_CASE("a whole plan is made where it finishes earlier, or leaves less border with not too many moves") {
  const std::vector<Move> six{{0_sub, 1_rank}, {1_sub, 1_rank}, {2_sub, 1_rank},
                              {3_sub, 1_rank}, {8_sub, 0_rank}, {9_sub, 0_rank}};
  const std::vector<Move> two{{6_sub, 1_rank}, {7_sub, 1_rank}}, one{{7_sub, 1_rank}};
  std::vector<Move> ten;  // the halves of the strip, exchanged
  for (const SubdomainId id : first_ids<SubdomainId>(6)) ten.push_back({id, 1_rank});
  for (const SubdomainId id : {8_sub, 9_sub, 10_sub, 11_sub}) ten.push_back({id, 0_rank});
  const std::vector<Move> scattered{{2_sub, 1_rank}, {5_sub, 1_rank}};
  CHECK(moves_made(ten, scattered, 5) == 10);
  CHECK(moves_made(ten, scattered, 4) == 2);
  CHECK(moves_made(ten, two, 5) == 2);
  CHECK(moves_made(six, one, 2) == 2);  // earlier by a ninth; the two that would be exchanged stay
}

TEST_CASE("single moves that are made in place of a whole plan are mended") {
  const std::vector<Move> apart{{2_sub, 1_rank}, {5_sub, 1_rank}}, useless{{0_sub, 1_rank}};
  CHECK(moves_of_leader(useless, apart, 1) == std::vector<Move>{{6_sub, 1_rank}, {7_sub, 1_rank}});
}

TEST_CASE("a whole plan that is not kept is asked for again when more is to be gained") {
  int plans = 0;
  class UselessPlans final : public Policy {
   public:
    explicit UselessPlans(int& plans) : plans_(plans) {}
    [[nodiscard]] Placement placement() const override { return Placement::kLeader; }
    [[nodiscard]] std::vector<Move> plan(const LoadSnapshot&, Rank) const override {
      ++plans_;
      return {{0_sub, 0_rank}};
    }
    [[nodiscard]] std::optional<std::vector<Move>> touch_up(const LoadSnapshot& snapshot) const override {
      return first_of(snapshot);
    }

   private:
    int& plans_;
  };
  ControllerOptions options = planning_early();
  options.overhead = 1;
  Controller leader(0_rank, std::make_shared<Layout>(grid_layout(40, 1, 2)), std::make_shared<UselessPlans>(plans),
                    options, 0);
  const auto plans_at = [&](std::uint32_t second, std::int32_t subdomains) {
    leader.receive(1_rank, LoadReport{second, 0, 100, {}}, second);
    static_cast<void>(leader.think(second, loads_of(0, subdomains - 1, 100), 100));
    return plans;
  };
  CHECK(plans_at(1, 20) == 1);
  CHECK(plans_at(5, 20) == 1);
  CHECK(plans_at(9, 15) == 1);
  CHECK(plans_at(13, 40) == 2);
  CHECK(plans_at(17, 30) == 2);
}

TEST_CASE("mending a plan and comparing its borders with those of single moves is charged") {
  const EffortLog log;
  const std::vector<Move> together{{6_sub, 1_rank}, {7_sub, 1_rank}}, apart{{2_sub, 1_rank}, {5_sub, 1_rank}};
  CHECK(moves_made(together, apart, 1) == 2);
  CHECK(moves_made(together, together, 1) == 2);  // the same: nothing to compare
  CHECK(log.efforts().at("border") == 3 * 12);
  CHECK(log.efforts().at("mend") >= 200 * 12);
}
