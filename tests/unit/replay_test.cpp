// Counted work, and recorded runs of it.
#include "cluster/replay/replay.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "balancer/policies/policy_factory.hpp"
#include "cluster/hindsight.hpp"
#include "cluster/simulated/simulate.hpp"
#include "driftmesh/generate.hpp"
#include "property/cases.hpp"
#include "support/id_literals.hpp"
#include "support/plans.hpp"

using namespace driftmesh;

namespace {

/// What `driftmesh run` records of a run.
RecordedRun recorded(const RunPlan& plan, const ClusterSpec& cluster, const ClusterRun& run) {
  RecordedRun record;
  record.layout = layout_of(plan, ranks_of(cluster));
  const IdVector<SubdomainId, double> work = work_done(run, speeds_of(cluster, {}), schedules_of(cluster));
  for (const SubdomainId s : ids_of(work)) record.work.push_back({0, work[s], (*record.layout)[s].predicted});
  record.cluster = cluster;
  record.slice = plan.work.slice;
  record.options = plan.balancing.options;
  return record;
}

/// Two to nine ranks of different speeds, some of which change.
ClusterSpec draw_cluster(std::mt19937_64& random) {
  ClusterSpec cluster;
  const auto ranks = static_cast<std::int32_t>(2 + random() % 8);
  for (std::int32_t r = 0; r < ranks; ++r)
    cluster.groups.push_back({"", 1, 1e5 * std::exp(static_cast<double>(random() % 150) / 100)});
  if (random() % 2 == 0) cluster.changes = {{.rank = ranks - 1, .at = 0.05, .factor = 0.4}};
  cluster.latency = random() % 2 == 0 ? 50e-6 : 1e-3;
  cluster.ranks_per_host = static_cast<std::int32_t>(1 + random() % 2);
  return cluster;
}

}  // namespace

TEST_CASE("counted work goes on elsewhere as it would have here") {
  auto random = testing::seeded_generator("counted work");
  for (std::int64_t i = testing::case_count(300); i > 0; --i) {
    const std::uint64_t seed = random();
    CAPTURE(seed);
    std::mt19937_64 one(seed);
    const Count count{.work = static_cast<double>(one() % 100'000) / 7,
                      .forecast = static_cast<double>(one() % 20'000)};
    CountedWork stays(3_sub, count, 1e-6), moves(3_sub, count, 1e-6);
    std::vector<SplitPoint<GlobalRootId>> said;
    double seconds = 0;
    std::int64_t triangles = 0;
    for (int slice = 0; stays.state().active; ++slice) {
      CHECK(stays.state().started == (slice > 0));
      CHECK(stays.state().remaining > 0);
      const auto insertions = static_cast<std::int64_t>(1 + one() % 5'000);
      const SliceWork done = stays.work(insertions, said);
      CHECK(done.begun == (slice == 0));
      CHECK(moves.work(insertions, said).seconds == done.seconds);
      moves = CountedWork::unpack(moves.pack(), 1e-6);
      seconds += done.seconds;
      triangles += done.triangles;
      CHECK(triangles == stays.state().triangles);
    }
    CHECK(seconds == doctest::Approx(1e-6 * count.work));
    CHECK(moves.id() == 3_sub);
    CHECK(moves.count().done == stays.count().work);
    CHECK(!moves.state().active);
    CHECK(stays.state().remaining == 0);
    CHECK(said.empty());
  }
}

TEST_CASE("a replay with the policy of the run takes about as long, and moves about as much") {
  auto random = testing::seeded_generator("replays");
  std::size_t moved = 0, moved_again = 0;
  double difference = 0, runs = 0;
  for (std::int64_t i = testing::case_count(6); i > 0; --i) {
    const std::uint64_t seed = random();
    CAPTURE(seed);
    std::mt19937_64 one(seed);
    const ClusterSpec cluster = draw_cluster(one);
    const std::int32_t ranks = ranks_of(cluster);
    const double triangles = 8e3 * ranks;
    RunPlan plan = testing::plan_for(generate_pipe({}), {20, {1.55 * 190'000 / triangles}, {}, nullptr}, ranks,
                                     16 * ranks, Presplit::kOn);
    plan.balancing.options.cost.latency = cluster.latency + 2 * cluster.message_overhead;
    for (const std::string& policy : balancer::policy_names()) {
      CAPTURE(policy);
      plan.balancing.policy = policy;
      prepare_balancing(plan, ranks, balancer::make_policy);
      const ClusterRun run = simulate(plan, cluster);
      const ReplayedRun replayed = replay(recorded(plan, cluster, run), balancer::make_policy(policy, {}));
      std::printf("%zu ranks, %-10s %.4f s and %3zu moves, again %.4f s and %3zu\n", run.ranks.size(), policy.c_str(),
                  run.makespan, run.moves.size(), replayed.seconds, replayed.moves);
      // Which rank is the first to ask may depend on the last digit of a time, and one move more or less is a tenth.
      CHECK(replayed.seconds == doctest::Approx(run.makespan).epsilon(policy == "none" ? 1e-3 : 0.5));
      CHECK((policy == "none") == (replayed.moves == 0));
      difference += std::abs(replayed.seconds / run.makespan - 1);
      ++runs;
      moved += run.moves.size();
      moved_again += replayed.moves;
    }
  }
  CHECK(difference < 0.08 * runs);
  CHECK(static_cast<double>(moved_again) == doctest::Approx(static_cast<double>(moved)).epsilon(0.25));
}
