#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "balancer/policies/policy_factory.hpp"
#include "balancer/snapshot/effort.hpp"
#include "cluster/simulated/simulate.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/generate.hpp"
#include "support/plans.hpp"

using namespace driftmesh;

namespace {

constexpr double kPipeArea = 190'000;

/// The pipe in about so many triangles.
RunPlan pipe_plan(double triangles, std::int32_t ranks, std::int32_t subdomains, Presplit presplit) {
  const QualityBounds bounds{20, {1.55 * kPipeArea / triangles}, {}, nullptr};
  return testing::plan_for(generate_pipe({}), bounds, ranks, subdomains, presplit);
}

ClusterSpec equal_ranks(std::int32_t ranks) {
  ClusterSpec cluster;
  cluster.groups = {{"all", ranks, 0}};
  return cluster;
}

}  // namespace

TEST_CASE("speeds follow the numbers of the ranks") {
  ClusterSpec cluster;
  cluster.groups = {{"slow", 2, 100e3}, {"as here", 1, 0}};
  const CostModel costs;
  CHECK(ranks_of(cluster) == 3);
  CHECK(speeds_of(cluster, costs) == IdVector<Rank, double>{100e3, 100e3, reference_speed(costs)});
  CHECK_THROWS_AS(static_cast<void>(speeds_of({}, costs)), Error);
  cluster.drag = {1, 0.5, 0.1};
  CHECK(speeds_of(cluster, costs) == IdVector<Rank, double>{100e3, 50e3, 0.1 * reference_speed(costs)});
  cluster.drag = {1, 1};
  CHECK_THROWS_AS(static_cast<void>(speeds_of(cluster, costs)), Error);
  cluster.drag = {1, 0, 1};
  CHECK_THROWS_AS(static_cast<void>(speeds_of(cluster, costs)), Error);
  cluster.drag.clear();
  cluster.groups[0].ranks = 0;
  CHECK_THROWS_AS(static_cast<void>(speeds_of(cluster, costs)), Error);
  cluster.groups[0] = {"backwards", 1, -1};
  CHECK_THROWS_AS(static_cast<void>(speeds_of(cluster, costs)), Error);
}

TEST_CASE("a run takes as long as changing speeds say, and the ideal follows them") {
  const RunPlan plan = pipe_plan(60e3, 2, 20, Presplit::kOn);
  ClusterSpec cluster = equal_ranks(2);
  const CostModel costs;
  const ClusterRun steady = simulate(plan, cluster, costs);
  cluster.changes = {{.rank = 0, .ranks = 2, .at = steady.makespan / 2, .factor = 0.25}};
  const ClusterRun slowed = simulate(plan, cluster, costs);
  CHECK(slowed.makespan == doctest::Approx(2.5 * steady.makespan).epsilon(0.01));  // half, and half at a quarter
  const IdVector<Rank, double> speeds = speeds_of(cluster, costs);
  const double ideal = ideal_seconds(slowed, speeds, schedules_of(cluster));
  CHECK(ideal <= slowed.makespan);
  CHECK(ideal == doctest::Approx(2.5 * ideal_seconds(steady, speeds)).epsilon(0.02));
  CHECK(ideal_seconds(steady, speeds, schedules_of(equal_ranks(2))) ==
        doctest::Approx(ideal_seconds(steady, speeds)).epsilon(1e-6));
  cluster.changes = {{.rank = 1, .ranks = 2, .at = 0, .factor = 1}};
  CHECK_THROWS_AS(static_cast<void>(schedules_of(cluster)), Error);
}

TEST_CASE("ranks on one host send through memory, not by a slow line") {
  const RunPlan plan = pipe_plan(60e3, 6, 60, Presplit::kOff);
  ClusterSpec cluster = equal_ranks(6);
  cluster.bandwidth = 2e6;
  const ClusterRun apart = simulate(plan, cluster, {});
  cluster.ranks_per_host = 6;
  CHECK(simulate(plan, cluster, {}).makespan < apart.makespan);
}

TEST_CASE("late ranks are known") {
  ClusterSpec cluster = equal_ranks(4);
  CHECK(late_ranks_of(cluster) == IdVector<Rank, bool>{false, false, false, false});
  cluster.changes = {{.rank = 1, .at = 0, .factor = 0},
                     {.rank = 1, .at = 2, .factor = 1},
                     {.rank = 3, .at = 1, .factor = 0},
                     {.rank = 3, .at = 2, .factor = 1}};
  CHECK(late_ranks_of(cluster) == IdVector<Rank, bool>{false, true, false, false});
}

TEST_CASE("a simulated run is reproducible, and its results are consistent") {
  const RunPlan plan = pipe_plan(60e3, 6, 60, Presplit::kOff);
  std::int64_t triangles = 0, last_progress = 0;
  std::size_t finished = 0;
  SimulationObservers observers;
  observers.progress = [&](std::int64_t now) { last_progress = now; };
  observers.finished = [&](const RankOutcome& rank, const std::map<SubdomainId, Subdomain>& subdomains) {
    CHECK(to_index(rank.subdomains) == subdomains.size());
    finished += subdomains.size();
    for (const auto& [id, subdomain] : subdomains) triangles += subdomain.triangles();
  };
  const ClusterRun run = simulate(plan, equal_ranks(6), {}, observers);
  CHECK(finished == plan.decomposition.size());
  CHECK(run.triangles() == triangles);
  CHECK(last_progress == triangles);
  CHECK(run.owners == plan.owners);
  std::int64_t sent = 0, handled = 0;
  for (const Rank r : ids_of(run.ranks)) {
    const RankOutcome& rank = run.ranks[r];
    sent += rank.counters.splits_sent;
    handled += rank.counters.splits_handled;
    CHECK(rank.times.total() <= run.makespan * (1 + 1e-9));
    CHECK(rank.times.total() > 0.99 * run.makespan - 1e-3);
    CHECK(rank.subdomains == std::count(plan.owners.begin(), plan.owners.end(), r));
  }
  CHECK(sent > 0);
  CHECK(sent == handled);
  const ClusterRun again = simulate(plan, equal_ranks(6));
  CHECK(again.makespan == run.makespan);
  CHECK(again.messages() == run.messages());
  CHECK(again.message_bytes() == run.message_bytes());
}

TEST_CASE("samples show the load of each rank decrease from its forecast to zero") {
  const RunPlan plan = pipe_plan(40e3, 4, 40, Presplit::kOn);
  const ClusterRun run = simulate(plan, equal_ranks(4));
  std::map<Rank, LoadSample> first, last;
  double time = 0;
  for (const LoadSample& s : run.samples) {
    CHECK(s.time >= time);
    time = s.time;
    first.emplace(s.rank, s);
    last[s.rank] = s;
  }
  REQUIRE(last.size() == 4);
  for (const auto& [rank, sample] : last) {
    double forecast = 0;
    for (const SubdomainId s : ids_of(plan.owners))
      if (plan.owners[s] == rank) forecast += plan.decomposition.subdomains[s].predicted;
    CHECK(first[rank].remaining == doctest::Approx(forecast));
    CHECK(first[rank].triangles == 0);
    CHECK(sample.remaining == 0);
    CHECK(sample.triangles == run.ranks[rank].triangles);
  }
}

TEST_CASE("a rank of half the speed computes twice as long") {
  const RunPlan plan = pipe_plan(40e3, 2, 40, Presplit::kOn);
  ClusterSpec cluster = equal_ranks(2);
  const ClusterRun equal = simulate(plan, cluster);
  const double speed = reference_speed({});
  cluster.groups = {{"fast", 1, speed}, {"slow", 1, speed / 2}};
  const ClusterRun unequal = simulate(plan, cluster);
  CHECK(unequal.ranks.front().times.computing == doctest::Approx(equal.ranks.front().times.computing));
  CHECK(unequal.ranks.back().times.computing == doctest::Approx(2 * equal.ranks.back().times.computing));
  CHECK(unequal.makespan == doctest::Approx(2 * equal.makespan).epsilon(0.1));
  CHECK(ideal_seconds(unequal, {2, 1}) == doctest::Approx(4.0 / 3 * equal.makespan).epsilon(0.1));
}

TEST_CASE("cutting takes time in proportion to the halvings") {
  const RunPlan plan = pipe_plan(40e3, 2, 64, Presplit::kOn);
  CostModel costs;
  costs.cut = 1e-3;
  CHECK(simulate(plan, equal_ranks(2), costs).cutting == doctest::Approx(64 * 6 * 1e-3));
  CHECK(cutting_seconds(costs, 1) == 0);
}

TEST_CASE("a slower network and costlier messages make the run longer") {
  const RunPlan plan = pipe_plan(40e3, 4, 40, Presplit::kOff);
  ClusterSpec cluster = equal_ranks(4);
  const double fast = simulate(plan, cluster).makespan;
  cluster.message_overhead = 1e-3;
  CHECK(simulate(plan, cluster).makespan > fast + 1e-3);
  cluster = equal_ranks(4);
  cluster.latency = 0.1;
  CHECK(simulate(plan, cluster).makespan > fast + 0.1);
}

TEST_CASE("planning keeps rank 0 from its work for as long as its costs say") {
  RunPlan plan = pipe_plan(40e3, 4, 80, Presplit::kOn);
  std::fill(plan.owners.begin(), plan.owners.end(), Rank{0});
  prepare_balancing(plan, 4, [](const std::string&, const auto&) {
    return balancer::leader_policy([](const balancer::LoadSnapshot&) {
      balancer::note_effort("rcb", 1);
      return std::vector<balancer::Move>{};
    });
  });
  const auto planning = [&](double seconds, double scale) {
    CostModel costs;
    costs.planning.unit = {{"rcb", seconds}};
    ClusterSpec cluster = equal_ranks(4);
    cluster.scale = scale;
    const ClusterRun run = simulate(plan, cluster, costs);
    CHECK(run.ranks.back().times.balancing < 1e-3);
    return run.ranks.front().times.balancing;
  };
  CHECK(planning(10e-3, 1) > planning(0, 1) + 9e-3);
  CHECK(planning(10e-3, 1) == planning(10e-3, 1));
  CHECK(planning(10e-3, 100) == doctest::Approx(planning(0.1e-3, 1)).epsilon(0.1));
}

TEST_CASE("a plan for more ranks than the cluster has is rejected") {
  const RunPlan plan = pipe_plan(5e3, 4, 12, Presplit::kOn);
  CHECK_THROWS_AS(static_cast<void>(simulate(plan, equal_ranks(3))), Error);
}

TEST_CASE("where details of the input decide, work is even on paper and balancing does no harm") {
  const QualityBounds bounds{30, {0}, {}, nullptr};
  RunPlan plan = testing::plan_for(generate_bay({}), bounds, 4, 200, Presplit::kOff);
  ClusterSpec cluster;
  cluster.groups = {{"slow", 4, 100e3}};
  cluster.scale = 79;  // each triangle stands for many, so that planning takes as long as on a real rank
  const double alone = simulate(plan, cluster).makespan;
  for (const char* const policy : {"greedy", "zoltan", "stealing"}) {
    CAPTURE(policy);
    plan.balancing.policy = policy;
    prepare_balancing(plan, 4, balancer::make_policy);
    CHECK(simulate(plan, cluster).makespan < 1.02 * alone);
  }
}
