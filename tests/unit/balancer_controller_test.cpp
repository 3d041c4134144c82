#include <doctest/doctest.h>

#include <algorithm>
#include <set>

#include "balancer/controller.hpp"
#include "balancer/effort.hpp"
#include "balancer/knowledge.hpp"
#include "balancer/policies/policy_factory.hpp"
#include "balancer/report_rule.hpp"
#include "support/id_literals.hpp"
#include "support/load_snapshots.hpp"

using namespace driftmesh;
using namespace driftmesh::balancer;
using driftmesh::testing::grid_layout;

namespace {

using Loads = std::vector<ReportedLoad>;

// Subdomains first .. last, of equal work, in epoch 0.
Loads loads_of(std::int32_t first, std::int32_t last, double work) {
  Loads loads;
  for (std::int32_t s = first; s <= last; ++s) loads.push_back({SubdomainId{s}, 0, work, 40});
  return loads;
}

/// Without waiting until a rank runs out of work soon.
ControllerOptions planning_early() {
  ControllerOptions options;
  options.ahead = 1;
  return options;
}

Controller controller_of(Rank self, const Layout& layout, const std::string& policy, double start = 0) {
  return Controller(self, std::make_shared<Layout>(layout), make_policy(policy), ControllerOptions{}, start);
}

template <class M>
std::vector<std::pair<Rank, M>> sent(const Decision& decision) {
  std::vector<std::pair<Rank, M>> found;
  for (const auto& o : decision.messages)
    if (const auto* const m = std::get_if<M>(&o.message)) found.emplace_back(o.destination, *m);
  return found;
}

}  // namespace

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

TEST_CASE("a planned move without news is forgotten") {
  Knowledge knowledge(std::make_shared<Layout>(grid_layout(4, 1, 2)), 10);
  knowledge.hear(0_rank, {1, 0, 0, loads_of(0, 1, 1000)}, 0);
  knowledge.expect(std::vector<Move>{{0_sub, 1_rank}}, knowledge.snapshot(0, true), 1, 0);
  knowledge.hear(1_rank, {1, 0, 0, loads_of(2, 3, 1000)}, 9);
  CHECK(knowledge.in_motion(0_sub));
  knowledge.hear(1_rank, {2, 0, 0, loads_of(2, 3, 1000)}, 11);
  CHECK(!knowledge.in_motion(0_sub));
}

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

namespace {

/// Plans of which each takes as long as it says, and single moves instead.
class SlowPlans final : public Policy {
 public:
  struct Asked {
    int plans = 0, touch_ups = 0;
  };
  SlowPlans(double seconds, Asked& asked) : seconds_(seconds), asked_(asked) {}
  [[nodiscard]] Placement placement() const override { return Placement::kLeader; }
  [[nodiscard]] std::vector<Move> plan(const LoadSnapshot&, Rank) const override {
    ++asked_.plans;
    return {};
  }
  [[nodiscard]] std::optional<std::vector<Move>> touch_up(const LoadSnapshot&) const override {
    ++asked_.touch_ups;
    return std::vector<Move>{};
  }
  [[nodiscard]] double planning_seconds(const LoadSnapshot&) const override { return seconds_; }

 private:
  double seconds_;
  Asked& asked_;
};

/// What a policy is asked in ten looks, a second apart, at a rank with all the work and one with none: 10 s can be
/// gained.
SlowPlans::Asked asked_in_ten_looks(double expected, double taken) {
  SlowPlans::Asked asked;
  ControllerOptions options;
  options.reference_speed = 100;  // that of these ranks
  Controller leader(0_rank, std::make_shared<Layout>(grid_layout(4, 1, 2)),
                    std::make_shared<SlowPlans>(expected, asked), options, 0);
  for (int i = 1; i <= 10; ++i) {
    leader.receive(1_rank, LoadReport{static_cast<std::uint32_t>(i), 0, 100, {}}, i);
    const int plans = asked.plans;
    if (leader.think(i, loads_of(0, 1, 1000), 100).planned) leader.took(asked.plans > plans ? taken : 1e-6);
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
  const SlowPlans::Asked seldom = asked_in_ten_looks(0.04, 0.04);  // a hundredth of the time, so every fourth second
  CHECK(seldom.plans == 3);
  CHECK(seldom.touch_ups == 10);
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

/// How many moves a leader with eight subdomains makes or advises when the other rank has four.
std::size_t moves_made(const std::vector<Move>& whole, const std::vector<Move>& single, double most_moves) {
  Controller leader(0_rank, std::make_shared<Layout>(grid_layout(12, 1, 2)),
                    std::make_shared<TwoPlans>(whole, single, most_moves), planning_early(), 0);
  leader.receive(1_rank, LoadReport{1, 0, 100, loads_of(8, 11, 1000)}, 1);
  const Decision decision = leader.think(1, loads_of(0, 7, 1000), 100);
  std::size_t moves = decision.moves.size();
  for (const auto& [to, plan] : sent<balancer::Plan>(decision)) moves += plan.moves.size();
  return moves;
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
  CHECK(moves_made(six, one, 2) == 6);  // by a ninth
}

TEST_CASE("a whole plan that is not kept is asked for again when more is to be gained") {
  const Layout layout = grid_layout(24, 1, 2);
  int plans = 0;
  class UselessPlans final : public Policy {
   public:
    explicit UselessPlans(int& plans) : plans_(plans) {}
    [[nodiscard]] Placement placement() const override { return Placement::kLeader; }
    [[nodiscard]] std::vector<Move> plan(const LoadSnapshot&, Rank) const override {
      ++plans_;
      return {{0_sub, 0_rank}};
    }
    [[nodiscard]] std::optional<std::vector<Move>> touch_up(const LoadSnapshot&) const override {
      return std::vector<Move>{};
    }

   private:
    int& plans_;
  };
  ControllerOptions options = planning_early();
  options.overhead = 1;
  Controller leader(0_rank, std::make_shared<Layout>(layout), std::make_shared<UselessPlans>(plans), options, 0);
  const auto plans_at = [&](std::uint32_t second, std::int32_t subdomains) {
    leader.receive(1_rank, LoadReport{second, 0, 100, {}}, second);
    static_cast<void>(leader.think(second, loads_of(0, subdomains - 1, 1000), 100));
    return plans;
  };
  CHECK(plans_at(1, 4) == 1);
  CHECK(plans_at(5, 4) == 1);
  CHECK(plans_at(9, 3) == 1);
  CHECK(plans_at(13, 8) == 2);
  CHECK(plans_at(17, 6) == 2);
}

TEST_CASE("comparing the borders of two plans is charged") {
  const EffortLog log;
  const std::vector<Move> together{{6_sub, 1_rank}, {7_sub, 1_rank}}, apart{{2_sub, 1_rank}, {5_sub, 1_rank}};
  CHECK(moves_made(together, apart, 1) == 2);
  CHECK(moves_made(together, together, 1) == 2);  // the same: nothing to compare
  CHECK(log.efforts().at("border") == 2 * 12);
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
  CHECK(!plans_when_left(30));  // of 45 seconds on average
  CHECK(!plans_when_left(12));
  CHECK(plans_when_left(8));  // of 34
  CHECK(plans_when_left(0));
}

TEST_CASE("a rank asks for work when it begins its last subdomain, however long that takes, or a little earlier") {
  const Layout layout = grid_layout(12, 1, 3);
  const auto asks = [&](const Loads& own) {
    Controller c = controller_of(1_rank, layout, "stealing");
    return !sent<balancer::WorkRequest>(c.think(0, own, 1000)).empty();
  };
  CHECK(asks(loads_of(4, 4, 1e6)));
  CHECK(!asks(loads_of(4, 5, 1000)));  // a second each
  CHECK(asks(loads_of(4, 5, 5)));
  // What is left in a finished subdomain whose neighbors have split its borders is no work to rely on.
  CHECK(asks({{4_sub, 0, 1000, 40}, {5_sub, 0, 100, 40}}));
  CHECK(!asks({{4_sub, 0, 1000, 40}, {5_sub, 0, 400, 40}}));
}

TEST_CASE("a rank that runs low sends a request and waits for the answer") {
  const Layout layout = grid_layout(12, 1, 3);
  Controller broker = controller_of(0_rank, layout, "stealing"), thief = controller_of(1_rank, layout, "stealing"),
             victim = controller_of(2_rank, layout, "stealing");
  broker.receive(2_rank, balancer::LoadNews{1, 4000, 3000, 100}, 1);
  CHECK(broker.think(1, loads_of(0, 1, 1000), 1000).moves.empty());

  const auto request = sent<balancer::WorkRequest>(thief.think(1, loads_of(4, 4, 10), 300));
  REQUIRE(request.size() == 1);
  CHECK(request[0].first == 0_rank);
  CHECK(thief.waiting());

  broker.receive(1_rank, request[0].second, 1);
  CHECK(broker.waiting());
  const auto passed_on = sent<balancer::WorkRequest>(broker.think(1, loads_of(0, 1, 1000), 1000));
  CHECK(!broker.waiting());
  REQUIRE(passed_on.size() == 1);
  CHECK(passed_on[0].first == 2_rank);

  victim.receive(0_rank, passed_on[0].second, 1);
  const Decision gift = victim.think(1, loads_of(8, 11, 1000), 100);
  const auto answer = sent<balancer::WorkAnswer>(gift);
  REQUIRE(answer.size() == 1);
  CHECK(answer[0].first == 1_rank);
  CHECK(gift.moves.size() == 3);
  for (const Move& move : gift.moves) CHECK(move.destination == 1_rank);

  thief.receive(2_rank, answer[0].second, 1);
  CHECK(!thief.waiting());
  CHECK(sent<balancer::WorkRequest>(thief.think(1.5, loads_of(4, 4, 5), 300)).empty());  // there is some on its way
}

TEST_CASE("a rank asks again when all promised subdomains have arrived, even if they were finished at once") {
  const Layout layout = grid_layout(12, 1, 3);
  for (const bool answer_first : {true, false}) {
    CAPTURE(answer_first);
    Controller thief = controller_of(1_rank, layout, "stealing");
    const auto request = sent<balancer::WorkRequest>(thief.think(1, loads_of(4, 4, 10), 300));
    REQUIRE(request.size() == 1);
    const balancer::WorkAnswer answer{request[0].second.round, {{8_sub, 1_rank}, {9_sub, 1_rank}}};
    if (answer_first) thief.receive(2_rank, answer, 1);
    thief.arrived(8_sub, 1, 1);
    CHECK(sent<balancer::WorkRequest>(thief.think(1.01, {}, 300)).empty());
    thief.arrived(9_sub, 1, 1);
    if (!answer_first) thief.receive(2_rank, answer, 1);
    CHECK(sent<balancer::WorkRequest>(thief.think(1.02, {}, 300)).size() == 1);
  }
}

TEST_CASE("the planner of a move learns that it was made, even if the subdomain was finished at once") {
  const Layout layout = grid_layout(12, 1, 2);
  Controller rank = controller_of(1_rank, layout, "greedy");
  CHECK(sent<LoadReport>(rank.think(1, loads_of(6, 11, 1000), 300)).size() == 1);
  rank.arrived(3_sub, 1, 1);
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

TEST_CASE("a refused rank stops asking and is served later") {
  const Layout layout = grid_layout(12, 1, 2);
  Controller broker = controller_of(0_rank, layout, "stealing"), thief = controller_of(1_rank, layout, "stealing");
  const auto request = sent<balancer::WorkRequest>(thief.think(1, {}, 300));
  REQUIRE(request.size() == 1);
  broker.receive(1_rank, balancer::LoadNews{1, 0, 0, 300}, 1);
  broker.receive(1_rank, request[0].second, 1);
  const auto refusal = sent<balancer::WorkAnswer>(broker.think(1, {}, 1000));
  REQUIRE(refusal.size() == 1);
  CHECK(refusal[0].second.moves.empty());
  thief.receive(0_rank, refusal[0].second, 1);
  CHECK(!thief.waiting());
  for (int i = 0; i < 100; ++i) CHECK(sent<balancer::WorkRequest>(thief.think(2 + i, {}, 300)).empty());

  // SPLITs have created work at the broker.
  CHECK(broker.think(200, loads_of(0, 4, 1000), 1000).moves.empty());
  const Decision late = broker.think(200.1, loads_of(0, 4, 1000), 1000);
  CHECK(!late.moves.empty());
  CHECK(sent<balancer::WorkAnswer>(late).size() == 1);
}

TEST_CASE("a rank that was refused with some work left is not taken for idle") {
  const Layout layout = grid_layout(12, 1, 3);
  Controller broker = controller_of(0_rank, layout, "stealing");
  broker.receive(2_rank, balancer::LoadNews{1, 0, 0, 300}, 1);
  broker.receive(1_rank, balancer::LoadNews{1, 25, 20, 300}, 1);
  broker.receive(1_rank, balancer::WorkRequest{1_rank, 1, 25, 300, 0}, 1);
  CHECK(sent<balancer::WorkAnswer>(broker.think(1, {}, 300)).size() == 1);  // nobody has any
  broker.receive(2_rank, balancer::LoadNews{2, 3000, 2000, 300}, 1.01);
  const auto request = sent<balancer::WorkRequest>(broker.think(1.01, {}, 300));
  const auto of_refused =
      std::find_if(request.begin(), request.end(), [](const auto& r) { return r.second.thief == 1_rank; });
  REQUIRE(of_refused != request.end());
  CHECK(of_refused->second.remaining > 0);
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
