// One rank's side of a joint planning round, step by step.
#include "balancer/collective_conduct.hpp"

#include <doctest/doctest.h>

#include "controller_fixture.hpp"
#include "driftmesh/error.hpp"

using namespace driftmesh;
using namespace driftmesh::balancer;
using namespace driftmesh::testing;
using Stage = balancer::JointRound::Stage;

namespace {

/// Decides as instructed, and records the contributions.
class ScriptedCouncil final : public Council {
 public:
  Decision next;
  std::vector<Contribution> brought;
  bool alone = false;  ///< the others are still to come

  [[nodiscard]] std::optional<Decision> decide(std::uint32_t, const Contribution& contribution) override {
    brought.push_back(contribution);
    if (alone) return std::nullopt;
    return next;
  }
};

/// Twelve subdomains of 1,000 triangles on three ranks.
struct Bench {
  ScriptedCouncil council;
  std::shared_ptr<const Layout> layout = std::make_shared<const Layout>(grid_layout(12, 1, 3));
  std::shared_ptr<const Policy> policy = make_policy("zoltan", {{"placement", "collective"}});

  /// Calls and starts a round for a rank with this work; it decides at its next think().
  static void begin_round(CollectiveConduct& rank, std::uint32_t number, double now,
                          const std::vector<ReportedLoad>& loads) {
    rank.receive(0_rank, JointRound{number, Stage::kCall}, now);
    static_cast<void>(rank.think({now, loads, 300}));
    rank.receive(0_rank, JointRound{number, Stage::kStart}, now);
  }
  CollectiveConduct rank(Rank self) { return {self, layout, ControllerOptions{}, council, 0}; }
  /// Rank 0 after all reports: rank 2 has much work, the others little.
  CollectiveConduct leader_that_knows() {
    CollectiveConduct leader = rank(0_rank);
    static_cast<void>(leader.think({0.01, loads_of(0, 0, 100), 300}));
    leader.receive(1_rank, LoadNews{1, 100, 0, 300}, 0.02);
    leader.receive(2_rank, LoadNews{1, 4000, 3000, 300}, 0.02);
    return leader;
  }
};

}  // namespace

TEST_CASE("rank 0 calls when there is something to gain, and starts the plan when all have acknowledged") {
  Bench bench;
  CollectiveConduct leader = bench.leader_that_knows();
  const auto call = sent<JointRound>(leader.think({0.05, loads_of(0, 0, 100), 300}));
  REQUIRE(call.size() == 2);
  CHECK(call[0] == std::pair<Rank, JointRound>{1_rank, {1, Stage::kCall}});
  CHECK(call[1] == std::pair<Rank, JointRound>{2_rank, {1, Stage::kCall}});
  CHECK(leader.waiting());
  CHECK(bench.council.brought.empty());

  leader.receive(1_rank, JointRound{1, Stage::kReady}, 0.06);
  CHECK(sent<JointRound>(leader.think({0.06, loads_of(0, 0, 100), 300})).empty());
  CHECK(!leader.pressing());
  leader.receive(2_rank, JointRound{1, Stage::kReady}, 0.07);
  const auto start = sent<JointRound>(leader.think({0.07, loads_of(0, 0, 100), 300}));
  REQUIRE(start.size() == 2);
  CHECK(start[1] == std::pair<Rank, JointRound>{2_rank, {1, Stage::kStart}});
  // The start must be sent to the others before rank 0 waits for them.
  CHECK(bench.council.brought.empty());
  CHECK(leader.pressing());

  bench.council.next.states = {{300, 1400}, {300, 1400}, {300, 1400}};
  const Decision decided = leader.think({0.08, loads_of(0, 0, 90), 300});
  CHECK(bench.council.brought.size() == 1);
  CHECK(bench.council.brought[0].state.remaining == 90);
  CHECK(decided.planned);
  CHECK(!leader.waiting());
  CHECK(sent<JointRound>(decided).empty());  // the decision balances the loads
}

TEST_CASE("rank 0 does not call while loads are even, nor before all speeds are known") {
  Bench bench;
  CollectiveConduct even = bench.rank(0_rank);
  for (const Rank r : {1_rank, 2_rank}) even.receive(r, LoadNews{1, 4000, 3000, 300}, 0.02);
  CHECK(sent<JointRound>(even.think({0.05, loads_of(0, 3, 1000), 300})).empty());
  CHECK(!even.waiting());

  CollectiveConduct early = bench.rank(0_rank);
  early.receive(2_rank, LoadNews{1, 40000, 3000, 300}, 0.02);
  CHECK(sent<JointRound>(early.think({0.05, loads_of(0, 0, 100), 300})).empty());
  CHECK(sent<JointRound>(early.think({1.5, loads_of(0, 0, 100), 300})).size() == 2);
}

TEST_CASE("a rank answers a call once, continues, and hands over what was decided and it still has") {
  Bench bench;
  CollectiveConduct rank = bench.rank(2_rank);
  rank.receive(0_rank, JointRound{1, Stage::kCall}, 1);
  CHECK(rank.waiting());  // the run does not end around it
  const auto answer = sent<JointRound>(rank.think({1, loads_of(8, 11, 1000), 300}));
  REQUIRE(answer.size() == 1);
  CHECK(answer[0] == std::pair<Rank, JointRound>{0_rank, {1, Stage::kReady}});
  rank.receive(0_rank, JointRound{1, Stage::kCall}, 1);
  CHECK(sent<JointRound>(rank.think({1.01, loads_of(8, 11, 990), 300})).empty());
  rank.receive(0_rank, JointRound{1, Stage::kStart}, 1.02);
  CHECK(rank.pressing());
  bench.council.alone = true;
  const Decision waits = rank.think({1.02, loads_of(9, 11, 980), 300});
  CHECK(waits.assembles);
  CHECK(!waits.planned);
  CHECK(rank.pressing());
  bench.council.alone = false;
  bench.council.next.moves = {{8_sub, 0_rank}, {9_sub, 1_rank}};
  const Decision decided = rank.think({1.02, loads_of(9, 11, 980), 300});  // 8 is finished
  CHECK(decided.moves == std::vector<Move>{{9_sub, 1_rank}});
  CHECK(sent<LoadNews>(decided).empty());  // subdomains about to leave are still listed
  CHECK(!rank.waiting());
  const auto news = sent<LoadNews>(rank.think({1.05, loads_of(10, 11, 970), 300}));
  REQUIRE(news.size() == 1);
  CHECK(news[0].second.remaining == 2 * 970);
  rank.receive(0_rank, JointRound{1, Stage::kStart}, 1.03);
  CHECK(!rank.pressing());
}

TEST_CASE("a subdomain that has just arrived stays, and one under way counts as work") {
  Bench bench;
  CollectiveConduct rank = bench.rank(1_rank);
  const auto round = [&](std::uint32_t number, double now) {
    Bench::begin_round(rank, number, now, loads_of(4, 5, 100));
    return rank.think({now, loads_of(4, 5, 100), 300});
  };
  bench.council.next.coming = {1000, 2};
  CHECK(sent<LoadNews>(round(1, 1)).empty());  // rank 0 knows more than the present load
  bench.council.next.coming = {0, 0};
  rank.arrived(5_sub, 1.1);
  static_cast<void>(round(2, 1.1));
  CHECK(bench.council.brought[1].state.remaining == 200 + 500);
  CHECK(bench.council.brought[1].settled == std::vector<SubdomainId>{5_sub});
  static_cast<void>(round(3, 1.2));  // the previous round promised nothing, and revokes nothing
  CHECK(bench.council.brought[2].state.remaining == 200 + 500);
  static_cast<void>(round(4, 4.5));
  CHECK(bench.council.brought[3].state.remaining == 200);
  CHECK(bench.council.brought[3].settled.empty());
}

TEST_CASE("a subdomain that arrives before the decision that promises it is not waited for") {
  Bench bench;
  CollectiveConduct rank = bench.rank(1_rank);
  Bench::begin_round(rank, 1, 1, {});
  rank.arrived(8_sub, 1.1);
  rank.arrived(9_sub, 1.1);
  bench.council.next.coming = {2000, 2};
  static_cast<void>(rank.think({1.1, loads_of(8, 9, 1000), 300}));
  const auto news = sent<LoadNews>(rank.think({1.2, loads_of(8, 9, 1000), 300}));
  REQUIRE(news.size() == 1);
  CHECK(news[0].second.remaining == 2000);
}

TEST_CASE("promised work that never arrives is not waited for forever") {
  Bench bench;
  CollectiveConduct rank = bench.rank(1_rank);
  Bench::begin_round(rank, 1, 1, {});
  bench.council.next.coming = {1000, 2};
  static_cast<void>(rank.think({1, {}, 300}));
  CHECK(sent<LoadNews>(rank.think({3.5, {}, 300})).empty());
  CHECK(sent<LoadNews>(rank.think({4.5, {}, 300})).size() == 1);
}

TEST_CASE("a controller of a collective policy needs a council, but not on a single rank") {
  Bench bench;
  CHECK_THROWS_AS(Controller(0_rank, bench.layout, bench.policy, ControllerOptions{}, 0), Error);
  Controller alone(0_rank, std::make_shared<const Layout>(grid_layout(3, 1, 1)), bench.policy, ControllerOptions{}, 0);
  CHECK(!alone.due(1));
}
