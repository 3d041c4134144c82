// Every policy on random loads.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "balancer/cost/move_cost.hpp"
#include "balancer/planner/ranks_by_finish.hpp"
#include "balancer/policies/policy_factory.hpp"
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

// The moves of all ranks together, for a policy that plans on every rank.
std::vector<Move> plan_of_all(const Policy& policy, const LoadSnapshot& snapshot) {
  if (policy.placement() != Placement::kNeighbors) return policy.plan(snapshot, Rank{0});
  std::vector<Move> moves;
  for (const Rank r : ids_of(snapshot.ranks))
    for (const Move& move : policy.plan(snapshot, r)) {
      REQUIRE(find(snapshot, move.subdomain)->owner == r);
      moves.push_back(move);
    }
  return moves;
}

// Longest processing time first, from an empty assignment.
double time_dealt_anew(const LoadSnapshot& snapshot) {
  const std::vector<double> speeds = assumed_speeds(snapshot.ranks);
  std::vector<double> work, load(speeds.size(), 0.0);
  for (const auto& s : snapshot.subdomains) work.push_back(s.remaining);
  std::sort(work.begin(), work.end(), std::greater<>());
  double last = 0;
  for (const double w : work) {
    std::size_t best = 0;
    for (std::size_t r = 1; r < speeds.size(); ++r)
      if ((load[r] + w) / speeds[r] < (load[best] + w) / speeds[best]) best = r;
    load[best] += w;
    last = std::max(last, load[best] / speeds[best]);
  }
  return last;
}

struct Named {
  std::string name;
  std::unique_ptr<Policy> policy;
};

std::vector<Named> planners() {
  std::vector<Named> list;
  for (const std::string name : {"none", "greedy", "diffusion"}) list.push_back({name, make_policy(name)});
  for (const std::string method : {"rcb", "hsfc", "graph", "hypergraph"})
    list.push_back({"zoltan " + method, make_policy("zoltan", {{"method", method}})});
  list.push_back({"zoltan raw", make_policy("zoltan", {{"approach", "partition"}, {"polish", "false"}})});
  return list;
}

}  // namespace

TEST_CASE("the rank for a subdomain is found without looking at all ranks") {
  auto random = testing::seeded_generator("ranks by finish");
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  std::size_t examined = 0, compared = 0;
  for (std::int64_t c = 0; c < testing::case_count(300); ++c) {
    CAPTURE(c);
    const std::size_t ranks = random() % (c % 10 == 0 ? 1000 : 40) + 1;
    const bool measured = random() % 2 == 0, idle = random() % 2 == 0, coarse = random() % 2 == 0;
    IdVector<Rank, double> speeds, loads;
    for (std::size_t r = 0; r < ranks; ++r) {
      speeds.push_back(static_cast<double>(1 + random() % 3) * 1e6 * (measured ? uniform(0.99, 1.01) : 1));
      loads.push_back(idle && random() % 2 == 0 ? 0 : coarse ? std::floor(uniform(0, 9)) * 1e5 : uniform(0, 1e6));
    }
    RanksByFinish searched(loads, speeds, 1e5);
    const double ideal = uniform(0.1, 1);
    for (int step = 0; step < 60; ++step) {
      const double work = coarse ? 1e5 : uniform(0, 3e5);
      const Rank owner{static_cast<std::int32_t>(random() % ranks)};
      const std::size_t refused = random() % 3;
      const auto may = [&](Rank r) { return to_index(r) % 3 != refused; };
      const auto finish = [&](Rank r) { return (loads[r] + work) / speeds[r]; };
      const auto room = [&](Rank r) { return ideal * speeds[r] - loads[r]; };
      Rank first = owner, roomiest{};
      for (const Rank r : ids_of(speeds)) {
        if (finish(r) < finish(first) && may(r)) first = r;
        if (room(r) > room(roomiest)) roomiest = r;
      }
      const Rank found = searched.earliest(work, owner, may);
      REQUIRE((found == owner || may(found)));
      REQUIRE(finish(found) == doctest::Approx(finish(first)).epsilon(1e-11));
      REQUIRE(room(searched.roomiest(ideal)) == doctest::Approx(room(roomiest)).epsilon(1e-11).scale(ideal * 3e6));
      loads[found] += work;
      searched.set_load(found, loads[found]);
      compared += 2 * ranks;
    }
    examined += searched.examined();
  }
  std::printf("looked at %zu ranks of %zu\n", examined, compared);
  CHECK(examined < compared / 3);
}

TEST_CASE("plans are valid and repeatable, and their worthwhile part finishes no later") {
  auto random = testing::seeded_generator("plans");
  const auto policies = planners();
  int moved = 0, gained = 0;
  for (std::int64_t i = testing::case_count(300); i > 0; --i) {
    const std::uint64_t seed = random();
    CAPTURE(seed);
    std::mt19937_64 one(seed);
    LoadSnapshot snapshot = random_snapshot(one);
    const auto fixed = one() % 3;  // in tenths
    for (SubdomainLoad& s : snapshot.subdomains) s.fixed = one() % 10 < fixed;
    const double before = time_with(snapshot, {});
    for (const auto& [name, policy] : policies) {
      CAPTURE(name);
      const auto plan = plan_of_all(*policy, snapshot);
      check_valid(snapshot, plan);
      REQUIRE(plan_of_all(*policy, snapshot) == plan);
      if (name == "greedy" || name == "diffusion") REQUIRE(time_with(snapshot, plan) <= before * (1 + 1e-12));

      const auto worth = worth_moving(snapshot, plan, {});
      check_valid(snapshot, worth);
      REQUIRE(worth.size() <= plan.size());
      if (!worth.empty()) REQUIRE(time_with(snapshot, worth) < before);
      moved += !plan.empty();
      gained += !worth.empty();
    }
  }
  CHECK(moved > 0);
  CHECK(gained > 0);
}

TEST_CASE("no plan is made beyond the memory of a rank") {
  auto random = testing::seeded_generator("memory");
  const auto policies = planners();
  int moved = 0, refused = 0;
  for (std::int64_t i = 0; testing::more_cases(i, 200, moved > 20 && refused > 20); ++i) {
    const std::uint64_t seed = random();
    CAPTURE(seed);
    std::mt19937_64 one(seed);
    LoadSnapshot snapshot = random_snapshot(one);
    for (RankLoad& rank : snapshot.ranks)
      rank.free_memory = ideal_time(snapshot) * std::uniform_real_distribution<double>(0, 2)(one);
    for (const auto& [name, policy] : policies) {
      CAPTURE(name);
      const auto plan = plan_of_all(*policy, snapshot);
      const auto worth = worth_moving(snapshot, plan, {});
      const IdVector<Rank, double> coming = memory_needed(snapshot, worth);
      for (const Rank r : ids_of(coming)) REQUIRE(coming[r] <= snapshot.ranks[r].free_memory * (1 + 1e-12));
      moved += !worth.empty();
      const IdVector<Rank, double> wanted = memory_needed(snapshot, plan);
      for (const Rank r : ids_of(wanted)) refused += wanted[r] > snapshot.ranks[r].free_memory;
      // These deal what they move to ranks that have memory for it, so nothing is refused.
      if (name == "greedy" || name.starts_with("zoltan"))
        for (const Rank r : ids_of(wanted)) REQUIRE(wanted[r] <= snapshot.ranks[r].free_memory * (1 + 1e-12));
    }
  }
  CHECK(moved > 20);
  CHECK(refused > 20);
}

TEST_CASE("greedy plans take at most three times as long as mapping everything again, largest first") {
  // A rank keeps at most its share of the ideal time, and what is assigned can be bounded as for list scheduling: with
  // o the best possible time, the last subdomain assigned and all before it run within o on ranks fast enough for them,
  // so these ranks are busy until the end minus o, with at most ideal + o of work. The end is thus at most ideal + 2 o
  // <= 3 o.
  auto random = testing::seeded_generator("greedy");
  const auto policy = make_policy("greedy", {{"tolerance", "0"}});
  for (std::int64_t i = testing::case_count(1000); i > 0; --i) {
    const std::uint64_t seed = random();
    CAPTURE(seed);
    std::mt19937_64 one(seed);
    const LoadSnapshot snapshot = random_snapshot(one);
    REQUIRE(time_with(snapshot, policy->plan(snapshot, Rank{0})) <= 3 * time_dealt_anew(snapshot) * (1 + 1e-12));
  }
}

TEST_CASE("gifts make the pair finish earlier, and thieves choose other ranks") {
  auto random = testing::seeded_generator("gifts");
  const auto policy = make_policy("stealing");
  int given = 0, asked = 0;
  for (std::int64_t i = testing::case_count(2000); i > 0; --i) {
    const std::uint64_t seed = random();
    CAPTURE(seed);
    std::mt19937_64 one(seed);
    const LoadSnapshot snapshot = random_snapshot(one);
    const auto ranks = snapshot.ranks.size();
    const Rank self = static_cast<Rank>(one() % ranks), other = static_cast<Rank>(one() % ranks);
    IdVector<Rank, bool> able(ranks);
    for (const Rank r : ids_of(able)) able[r] = one() % 2 == 0;
    if (const auto victim = policy->victim(snapshot, self, able)) {
      ++asked;
      REQUIRE(*victim != self);
      REQUIRE(able[*victim]);
    }
    if (other == self) continue;
    const auto moves = policy->give(snapshot, self, other);
    check_valid(snapshot, moves);
    LoadSnapshot pair = snapshot;
    std::erase_if(pair.subdomains, [&](const auto& s) { return s.owner != self && s.owner != other; });
    if (!moves.empty()) REQUIRE(time_with(pair, moves) < time_with(pair, {}));
    given += !moves.empty();
  }
  CHECK(given > 0);
  CHECK(asked > 0);
}
