// The policy developed in docs/write-a-policy.md works as described there.
#include <doctest/doctest.h>

#include <algorithm>

#include "driftmesh/error.hpp"
#include "support/balanced_ranks.hpp"

using namespace driftmesh;
using namespace driftmesh::balancer;

TEST_CASE("the factory makes the policy of the page") {
  const auto names = policy_names();
  CHECK(std::count(names.begin(), names.end(), "pairs") == 1);
  CHECK_THROWS_WITH_AS(static_cast<void>(make_policy("pairs", {{"shares", "0.5"}})),
                       "policy pairs: unknown parameter 'shares'; the nearest one is 'share'", InputError);
  CHECK_THROWS_WITH_AS(static_cast<void>(make_policy("pairs", {{"share", "2"}})),
                       "policy pairs: share: '2' cannot be used; it must be a number from 0 to 1", InputError);
}

TEST_CASE("it balances pairs of ranks") {
  const LoadSnapshot s = testing::initial_snapshot(testing::grid_layout(40, 1, 4), {100, 100, 300, 300});
  const auto moves = make_policy("pairs")->plan(s, Rank{0});
  CHECK(!moves.empty());
  CHECK(testing::time_with(s, moves) < 1.25 * ideal_time(s));
  CHECK(make_policy("pairs", {{"share", "0"}})->plan(s, Rank{0}).empty());
}

TEST_CASE("it balances whole runs") {
  testing::Cluster cluster;
  cluster.speeds = {1e6, 1e6, 1e6, 3e6, 2e6, 1e6, 3e6, 2e6};
  testing::Layout layout = testing::grid_layout(20, 20, 8);
  for (auto& s : layout.subdomains) s.predicted = 50e3;
  const testing::Jobs jobs(400, testing::Job{0, 50e3, 50e3});
  const auto none = testing::run_jobs(cluster, layout, jobs, "none");
  const auto pairs = testing::run_jobs(cluster, layout, jobs, "pairs");
  CHECK(pairs.complete);
  CHECK(none.time > 1.5 * none.ideal);
  CHECK(pairs.time < 1.2 * pairs.ideal);
}
