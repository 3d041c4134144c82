// Joint plans of all ranks, on random loads.
#include <doctest/doctest.h>

#include "balancer/policies/policy_factory.hpp"
#include "balancer/simulated/simulated_council.hpp"
#include "property/cases.hpp"
#include "support/joint_rounds.hpp"

using namespace driftmesh;
using namespace driftmesh::balancer;
using namespace driftmesh::testing;

namespace {

std::shared_ptr<const Policy> zoltan(Parameters::Values parameters) {
  parameters["placement"] = "collective";
  return make_policy("zoltan", parameters);
}

std::vector<Council::Decision> hold_round(const std::shared_ptr<const Policy>& policy, const LoadSnapshot& snapshot,
                                          const std::vector<Contribution>& contributions,
                                          const ControllerOptions& options = {}) {
  SimulatedCouncil council(snapshot.layout, policy, options);
  for (const Contribution& c : contributions) REQUIRE(!council.decide(1, c));  // they come together
  std::vector<Council::Decision> decisions;
  for (const Contribution& c : contributions) decisions.push_back(council.decide(1, c).value());
  CHECK(!council.in_session());
  return decisions;
}

}  // namespace

TEST_CASE("a joint plan is valid, repeatable, known to all ranks, and finishes earlier") {
  auto random = seeded_generator("joint plans");
  int moved = 0, single = 0, many = 0;
  for (std::int64_t i = 0; more_cases(i, 300, single > 0 && many > 0); ++i) {
    const std::uint64_t seed = random();
    CAPTURE(seed);
    std::mt19937_64 one(seed);
    const LoadSnapshot snapshot = random_snapshot(one);
    const std::vector<Contribution> contributions = contributions_of(snapshot, &one);
    for (const std::string method : {"rcb", "graph", "hypergraph"}) {
      CAPTURE(method);
      const bool polish = one() % 4 != 0;
      const auto policy = zoltan({{"method", method}, {"polish", polish ? "true" : "false"}});
      const auto decisions = hold_round(policy, snapshot, contributions);
      REQUIRE(problem_of(snapshot, contributions, decisions) == "");
      const auto moves = all_moves(decisions);
      REQUIRE(all_moves(hold_round(policy, snapshot, contributions)) == moves);
      if (moves.empty()) continue;
      REQUIRE(time_with(snapshot, moves) < time_with(snapshot, {}));
      ++moved;
      single += moves.size() < 4;
      many += moves.size() > 8;
    }
  }
  CHECK(moved > 0);
  CHECK(single > 0);
  CHECK(many > 0);
}

TEST_CASE("many subdomains on ranks of three speeds end up balanced, whatever the start") {
  const IdVector<Rank, double> speeds{1e5, 1e5, 2e5, 2e5, 2e5, 3e5, 3e5, 1e5};
  check_balanced(
      grid_layout(40, 40, 8), speeds,
      [](const std::string& method, const std::string& approach, const auto& snapshot, const auto& contributions) {
        return hold_round(zoltan({{"method", method}, {"approach", approach}}), snapshot, contributions);
      });
}

TEST_CASE("work under way counts, and nothing moves that is not worth it") {
  LoadSnapshot snapshot = initial_snapshot(grid_layout(20, 20, 2), {1e5, 1e5});
  auto contributions = contributions_of(snapshot);
  CHECK(all_moves(hold_round(zoltan({}), snapshot, contributions)).empty());  // it is balanced
  contributions[1].state.remaining += 100e3;
  const auto decisions = hold_round(zoltan({}), snapshot, contributions);
  CHECK(decisions[0].moves.empty());
  CHECK(decisions[1].moves.size() == doctest::Approx(50).epsilon(0.1));

  for (auto& s : contributions[1].own) s.bytes = 100'000'000;  // it takes longer to pack one than to finish it
  CHECK(all_moves(hold_round(zoltan({}), snapshot, contributions)).empty());
}

// As for plans of a leader. A round is called then, so one that doubts call off costs all ranks for nothing.
TEST_CASE("doubts about the work of others do not keep a rank idle in a joint plan either") {
  LoadSnapshot start = initial_snapshot(grid_layout(20, 20, 3), {1e5, 1e5, 1e5});
  for (RankLoad& rank : start.ranks) rank.doubt = 2;
  for (const bool idle : {true, false}) {
    LoadSnapshot snapshot = start;
    if (idle) std::erase_if(snapshot.subdomains, [](const SubdomainLoad& s) { return s.owner == Rank{2}; });
    for (SubdomainLoad& s : snapshot.subdomains)
      if (s.owner == Rank{0}) s.remaining *= 2;
    sum_up(snapshot);
    CHECK(all_moves(hold_round(zoltan({}), snapshot, contributions_of(snapshot))).empty() == !idle);
  }
}
