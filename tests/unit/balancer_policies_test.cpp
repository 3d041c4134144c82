#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "balancer/policies/policy_factory.hpp"
#include "balancer/snapshot/partners.hpp"
#include "driftmesh/error.hpp"
#include "support/error_text.hpp"
#include "support/id_literals.hpp"
#include "support/load_snapshots.hpp"

using namespace driftmesh;
using namespace driftmesh::testing;
using namespace driftmesh::balancer;
using driftmesh::testing::grid_layout;
using driftmesh::testing::initial_snapshot;
using driftmesh::testing::time_with;

namespace {

std::string error_of(const std::string& name, const Parameters::Values& values = {}) {
  return error_text<InputError>([&] { static_cast<void>(make_policy(name, values)); });
}

double cut_length(const LoadSnapshot& snapshot) {
  double length = 0;
  for (const SubdomainLoad& s : snapshot.subdomains)
    for (const Neighbor& n : (*snapshot.layout)[s.id].neighbors)
      if (find(snapshot, n.subdomain)->owner != s.owner) length += n.length / 2;
  return length;
}

}  // namespace

TEST_CASE("wrong names, parameters and values are errors that suggest what was meant") {
  CHECK(error_of("soltan") == "unknown policy 'soltan'; the nearest one is 'zoltan'");
  CHECK(error_of("none", {{"method", "rcb"}}) == "policy none: unknown parameter 'method'; it has none");
  CHECK(error_of("greedy", {{"tolerence", "1"}}) ==
        "policy greedy: unknown parameter 'tolerence'; the nearest one is 'tolerance'");
  CHECK(error_of("greedy", {{"tolerance", "much"}}) ==
        "policy greedy: tolerance: 'much' cannot be used; it must be a number from 0 to 10");
  CHECK(error_of("greedy", {{"tolerance", "nan"}}) ==
        "policy greedy: tolerance: 'nan' cannot be used; it must be a number from 0 to 10");
  CHECK(error_of("stealing", {{"low-water", "-1"}}) ==
        "policy stealing: low-water: '-1' cannot be used; it must be a number from 0 to 1e+06");
  CHECK(error_of("zoltan", {{"method", "hypergraf"}}) ==
        "policy zoltan: method: 'hypergraf' cannot be used; the nearest choice is 'hypergraph'");
  CHECK(error_of("zoltan", {{"polish", "yes"}}) ==
        "policy zoltan: polish: 'yes' cannot be used; it must be true or false");
  CHECK(error_of("zoltan", {{"seed", "1.5"}}) ==
        "policy zoltan: seed: '1.5' cannot be used; it must be a whole number from 0 to 2147483647");
  CHECK(error_of("zoltan", {{"PHG_REPART_MULTIPLYER", "10"}}) ==
        "policy zoltan: unknown parameter 'PHG_REPART_MULTIPLYER'; the nearest one is 'PHG_REPART_MULTIPLIER'");
  CHECK(error_of("zoltan", {{"IMBALANCE_TOL", "tight"}}) ==
        "policy zoltan: IMBALANCE_TOL: 'tight' cannot be used; Zoltan's user guide lists valid values");
  for (const std::string& name : policy_names()) CHECK(error_of(name) == "no error");
}

TEST_CASE("the policy none moves nothing") {
  const auto policy = make_policy("none");
  CHECK(policy->placement() == Placement::kNobody);
  const LoadSnapshot s = initial_snapshot(grid_layout(6, 6, 2), {1, 100});
  CHECK(policy->plan(s, 0_rank).empty());
  CHECK(!policy->runs_low(0));
  CHECK(!policy->victim(s, 1_rank, {true, true}));
  CHECK(policy->give(s, 0_rank, 1_rank).empty());
}

TEST_CASE("greedy moves no more than it must") {
  const auto policy = make_policy("greedy");
  CHECK(policy->placement() == Placement::kLeader);
  const LoadSnapshot s = initial_snapshot(grid_layout(10, 10, 4), {100, 100, 100, 200});
  const auto moves = policy->plan(s, 0_rank);
  CHECK(moves.size() == 15);
  for (const Move& move : moves) CHECK(move.destination == 3_rank);
  CHECK(time_with(s, moves) == 200);
}

TEST_CASE("zoltan balances work over speed with every method and approach") {
  const IdVector<Rank, double> speeds{110, 110, 92, 186, 186, 110, 186, 92};
  const LoadSnapshot s = initial_snapshot(grid_layout(16, 14, 8), speeds);
  for (const char* method : {"rcb", "hsfc", "graph", "hypergraph"})
    for (const char* approach : {"partition", "repartition", "refine"}) {
      CAPTURE(method);
      CAPTURE(approach);
      const auto policy = make_policy("zoltan", {{"method", method}, {"approach", approach}});
      CHECK(policy->placement() == Placement::kLeader);
      const auto moves = policy->plan(s, 0_rank);
      CHECK(time_with(s, moves) < 1.06 * ideal_time(s));
      CHECK(policy->plan(s, 0_rank) == moves);  // a pure function
    }
}

TEST_CASE("zoltan's graphs keep borders between ranks short, and repartition moves less than partition") {
  const LoadSnapshot s = initial_snapshot(grid_layout(40, 40, 8), {1, 1, 1, 1, 2, 2, 2, 2});
  const auto moves_of = [&](const char* approach) {
    return make_policy("zoltan", {{"method", "graph"}, {"approach", approach}})->plan(s, 0_rank);
  };
  const auto moves = moves_of("partition");
  LoadSnapshot scattered = s;
  for (auto& subdomain : scattered.subdomains) subdomain.owner = Rank{to_int(subdomain.id) % 8};
  CHECK(cut_length(after(s, moves)) < 0.15 * cut_length(scattered));
  CHECK(moves_of("repartition").size() < moves.size());
}

TEST_CASE("zoltan accepts its own parameters") {
  const LoadSnapshot s = initial_snapshot(grid_layout(20, 20, 4), {1, 1, 1, 3});
  const auto strict = make_policy("zoltan", {{"polish", "false"}, {"IMBALANCE_TOL", "1.01"}})->plan(s, 0_rank);
  const auto loose = make_policy("zoltan", {{"polish", "false"}, {"IMBALANCE_TOL", "1.5"}})->plan(s, 0_rank);
  CHECK(time_with(s, strict) < time_with(s, loose));
}

// Debian's Zoltan has SCOTCH, and no ParMETIS; others may have both, or neither.
TEST_CASE("zoltan's graphs can be partitioned by others, or it says at once that they are not there") {
  const LoadSnapshot s = initial_snapshot(grid_layout(24, 24, 4), {1, 1, 1, 2});
  for (const std::string package : {"Scotch", "ParMETIS"})
    for (const std::string approach : {"repartition", "partition"}) {
      CAPTURE(package);
      CAPTURE(approach);
      const Parameters::Values values{{"GRAPH_PACKAGE", package},
                                      {"method", "graph"},
                                      {"approach", approach},
                                      {"polish", "false"},
                                      {"touch-up", "0"}};
      if (const std::string error = error_of("zoltan", values); error != "no error") {
        MESSAGE("without " << package);
        CHECK(error == "policy zoltan: GRAPH_PACKAGE: '" + package +
                           "' cannot be used; this Zoltan was built without it; PHG is always there");
        continue;
      }
      const auto policy = make_policy("zoltan", values);
      const auto moves = policy->plan(s, 0_rank);
      CHECK(time_with(s, moves) < 1.1 * ideal_time(s));
      CHECK(policy->plan(s, 0_rank) == moves);  // a pure function
      // Ranks of the same speed need not swap their parts.
      LoadSnapshot swapped = after(s, moves);
      for (auto& subdomain : swapped.subdomains)
        if (subdomain.owner < 3_rank) subdomain.owner = Rank{(to_int(subdomain.owner) + 1) % 3};
      sum_up(swapped);
      CHECK(policy->plan(swapped, 0_rank).empty());
    }
  const auto moves_of = [&](const char* package) {
    return make_policy("zoltan", {{"method", "graph"}, {"GRAPH_PACKAGE", package}})->plan(s, 0_rank);
  };
  CHECK(moves_of("phg") == moves_of("PHG"));
}

TEST_CASE("zoltan plans on rank 0, and refuses plans of all ranks at once with what to use instead") {
  for (const Parameters::Values& values : {Parameters::Values{}, {{"placement", "leader"}}})
    CHECK(make_policy("zoltan", values)->placement() == Placement::kLeader);
  CHECK(error_of("zoltan", {{"placement", "collective"}}) ==
        "policy zoltan: placement: 'collective' cannot be used; leave it out, and rank 0 plans for all; where that "
        "takes too long, use the policy stealing");
  CHECK(error_of("zoltan", {{"placement", "colective"}}) ==
        "policy zoltan: placement: 'colective' cannot be used; the nearest choice is 'leader'");
}

TEST_CASE("zoltan copes with fewer subdomains than ranks, none, and one rank") {
  for (const char* method : {"rcb", "hsfc", "graph", "hypergraph"}) {
    CAPTURE(method);
    const auto policy = make_policy("zoltan", {{"method", method}});
    LoadSnapshot few = initial_snapshot(grid_layout(3, 1, 12), IdVector<Rank, double>(12, 1.0));
    for (auto& subdomain : few.subdomains) subdomain.owner = 5_rank;
    sum_up(few);
    CHECK(time_with(few, policy->plan(few, 0_rank)) <= finishing_time(few));
    few.subdomains.clear();
    sum_up(few);
    CHECK(policy->plan(few, 0_rank).empty());
    CHECK(policy->plan(initial_snapshot(grid_layout(4, 4, 1), {1}), 0_rank).empty());
  }
}

TEST_CASE("diffusion sends work to the partners that finish earlier") {
  const auto policy = make_policy("diffusion");
  CHECK(policy->placement() == Placement::kNeighbors);
  // Three ranks in a row, the first one ten times as fast as the others.
  const LoadSnapshot s = initial_snapshot(grid_layout(90, 10, 3), {1000, 100, 100});
  CHECK(policy->plan(s, 0_rank).empty());
  const auto moves = policy->plan(s, 1_rank);
  CHECK(!moves.empty());
  for (const Move& move : moves) {
    CHECK(move.destination == 0_rank);
    CHECK(find(s, move.subdomain)->owner == 1_rank);
  }
  for (const Move& move : policy->plan(s, 2_rank)) CHECK(move.destination == 0_rank);  // all others are its partners
}

TEST_CASE("diffusion gives nothing that is worked on, however close it is to the other rank") {
  LoadSnapshot s = initial_snapshot(grid_layout(6, 1, 2), {100, 100});
  for (SubdomainLoad& load : s.subdomains) load.owner = load.id < 5_sub ? 0_rank : 1_rank;
  s.subdomains[5].remaining = 1;
  sum_up(s);
  const auto given = [&](SubdomainId worked_on) {
    std::int32_t turn = 1;
    for (SubdomainLoad& load : s.subdomains) load.turn = load.id == worked_on || load.owner == 1_rank ? 0 : turn++;
    return make_policy("diffusion")->plan(s, 0_rank);
  };
  // First the one next to the other rank, then the one whose turn is last.
  CHECK(given(0_sub) == std::vector<Move>{{4_sub, 1_rank}, {3_sub, 1_rank}});
  // First the one with least border to what stays.
  CHECK(given(4_sub) == std::vector<Move>{{0_sub, 1_rank}, {3_sub, 1_rank}});
}

TEST_CASE("each rank is a partner of its distant partners, and all of each other over a few steps") {
  for (const std::int32_t ranks : {1, 2, 3, 4, 16, 144, 1000}) {
    CAPTURE(ranks);
    std::set<Rank> reached{0_rank};
    int steps = 0;
    for (; reached.size() < to_index(ranks); ++steps)
      for (const Rank r : std::set<Rank>(reached))
        for (const Rank partner : distant_partners(r, ranks)) reached.insert(partner);
    CHECK(steps <= 1 + 2 * std::log2(ranks));
    for (const Rank r : first_ids<Rank>(ranks)) {
      const std::vector<Rank> partners = distant_partners(r, ranks);
      CHECK(static_cast<double>(partners.size()) <= 2 + std::log2(ranks));
      for (const Rank partner : partners) {
        CHECK(partner != r);
        CHECK(std::ranges::count(distant_partners(partner, ranks), r) == 1);
      }
    }
  }
}

TEST_CASE("repeated diffusion evens out a chain of ranks") {
  const auto policy = make_policy("diffusion");
  LoadSnapshot s = initial_snapshot(grid_layout(60, 60, 6), {1, 2, 3, 4, 5, 6});
  const double before = finishing_time(s) / ideal_time(s);
  for (int round = 0; round < 100; ++round) {
    std::vector<Move> moves;
    for (const Rank r : first_ids<Rank>(6))
      for (const Move& move : policy->plan(s, r)) moves.push_back(move);
    s = after(s, moves);
  }
  CHECK(before > 3);
  CHECK(finishing_time(s) / ideal_time(s) < 1.1);
}

TEST_CASE("diffusion gets work out of the middle of a region of slow ranks in a few rounds") {
  const auto policy = make_policy("diffusion");
  IdVector<Rank, double> speeds(64, 1.0);
  for (const Rank r : first_ids<Rank>(32)) speeds[r] = 3;
  LoadSnapshot s = initial_snapshot(grid_layout(64, 30, 64), speeds);
  CHECK(finishing_time(s) / ideal_time(s) > 1.9);
  for (int round = 0; round < 10; ++round) {
    std::vector<Move> moves;
    for (const Rank r : first_ids<Rank>(64))
      for (const Move& move : policy->plan(s, r)) moves.push_back(move);
    s = after(s, moves);
  }
  CHECK(finishing_time(s) / ideal_time(s) < 1.15);
}

TEST_CASE("a rank that runs low gets work from the one that will finish last") {
  const auto policy = make_policy("stealing", {{"low-water", "0.5"}});
  CHECK(policy->placement() == Placement::kRequests);
  CHECK(policy->runs_low(0));
  CHECK(policy->runs_low(0.4));
  CHECK(!policy->runs_low(0.6));
  LoadSnapshot s = initial_snapshot(grid_layout(12, 1, 4), {1000, 1000, 1000, 1000});
  const IdVector<Rank, bool> all(4, true);
  s.ranks[1_rank].remaining = 400;
  s.ranks[2_rank].remaining = 8000;
  s.ranks[3_rank].remaining = 9000;
  CHECK(policy->victim(s, 1_rank, all) == 3_rank);
  CHECK(policy->victim(s, 1_rank, {true, true, true, false}) == 2_rank);  // rank 3 has nothing to give
  s.ranks[3_rank].speed = 1e6;
  CHECK(policy->victim(s, 1_rank, all) == 2_rank);  // rank 3 is so fast that it needs no help
  s.ranks[3_rank].speed = 0;
  CHECK(policy->victim(s, 1_rank, all) == 3_rank);  // probably as fast as the others
  s.ranks[0_rank].remaining = s.ranks[2_rank].remaining = s.ranks[3_rank].remaining = 400;
  CHECK(!policy->victim(s, 1_rank, all));  // they will not finish later
}

TEST_CASE("a rank gives as long as the other one finishes earlier with it") {
  const auto policy = make_policy("stealing");
  LoadSnapshot s = initial_snapshot(grid_layout(20, 1, 2), {100, 300});
  s.ranks[1_rank].remaining = 0;
  const auto moves = policy->give(s, 0_rank, 1_rank);
  CHECK(moves.size() == 8);  // 8 of 10: 20 s against 26.7 s; with a ninth it would be 10 s against 30 s
  for (const Move& move : moves) CHECK(move.destination == 1_rank);
  s.ranks[1_rank].remaining = 1e6;
  CHECK(policy->give(s, 0_rank, 1_rank).empty());
}
