// Balancing never harms: whole runs on simulated ranks, with and without it.
#include <doctest/doctest.h>

#include <cstdio>

#include "property/cases.hpp"
#include "support/balancing_scenarios.hpp"

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

/// The time of the best schedule that is known for this work: largest first, each to the rank that finishes it first.
double oracle_time(const Staged& staged) {
  std::vector<double> work;
  for (const Job& job : staged.jobs) work.push_back(job.work);
  std::ranges::sort(work, std::greater());
  IdVector<Rank, double> load(staged.cluster.speeds.size(), 0.0);
  double last = 0;
  for (const double w : work) {
    Rank best{0};
    for (const Rank r : ids_of(load))
      if ((load[r] + w) / staged.cluster.speeds[r] < (load[best] + w) / staged.cluster.speeds[best]) best = r;
    load[best] += w;
    last = std::max(last, load[best] / staged.cluster.speeds[best]);
  }
  return last;
}

/// Latencies are known to whoever runs a cluster, and given to the balancer.
balancer::ControllerOptions options_for(const Cluster& cluster) {
  balancer::ControllerOptions options;
  options.cost.latency = std::max(options.cost.latency, cluster.latency);
  return options;
}

}  // namespace

// With forecasts that are off by random factors up to 4, a plan can be unlucky, but only seldom and not by much; and on
// the whole each policy gains.
TEST_CASE("no policy harms, whatever the cluster, the work and the forecasts") {
  auto random = seeded_generator("harmless");
  struct Harm {
    double log_ratio = 0;  // sum over scenarios
    int harmed = 0;        // scenarios that took more than 2 percent longer than without balancing
  };
  std::map<std::string, Harm> harms;
  const std::vector<BalancingScenario> scenarios = balancing_scenarios();
  for (const BalancingScenario& scenario : scenarios) {
    const std::uint64_t seed = random();
    CAPTURE(scenario.name());
    CAPTURE(seed);
    const Staged staged = stage(scenario, seed);
    const double oracle = oracle_time(staged);
    const auto run = [&](const std::string& policy) {
      const Outcome o = run_jobs(staged.cluster, staged.layout, staged.jobs, policy, {}, options_for(staged.cluster));
      CHECK(o.complete);
      return o;
    };
    const Outcome none = run("none");
    std::printf("%s: none %.3f of the oracle", scenario.name().c_str(), none.time / oracle);
    for (const char* policy : {"diffusion", "greedy", "zoltan", "stealing"}) {
      CAPTURE(policy);
      const Outcome o = run(policy);
      const bool harmed = o.time > 1.02 * none.time;
      std::printf(", %s %.3f%s (%d moves)", policy, o.time / oracle, harmed ? "!" : "", o.moves);
      CHECK(o.time <= 2 * none.time);
      harms[policy].log_ratio += std::log(o.time / none.time);
      harms[policy].harmed += harmed ? 1 : 0;
    }
    std::printf("\n");
  }
  for (const auto& [policy, harm] : harms) {
    CAPTURE(policy);
    const double mean = std::exp(harm.log_ratio / static_cast<double>(scenarios.size()));
    std::printf("%s takes %.3f of the time without balancing, and harms in %d of %zu scenarios\n", policy.c_str(), mean,
                harm.harmed, scenarios.size());
    CHECK(harm.harmed <= 6);
    CHECK(mean < 0.8);
  }
}

// Where forecasts say next to nothing, what ranks tell of themselves must do: those without work are a fact.
TEST_CASE("forecasts off by factors up to 16 cost every policy little") {
  auto random = seeded_generator("harmless");
  std::map<std::string, double> log_ratio;
  int count = 0;
  for (const std::int32_t ranks : {4, 16, 48})
    for (const int per_rank : {12, 40})
      for (const auto errors : {Errors::kScattered, Errors::kClustered})
        for (const double seconds : {1.0, 10.0}) {
          BalancingScenario scenario;
          scenario.ranks = ranks, scenario.per_rank = per_rank, scenario.error = 16;
          scenario.errors = errors, scenario.seconds = seconds;
          const std::uint64_t seed = random();
          CAPTURE(scenario.name());
          CAPTURE(seed);
          const Staged staged = stage(scenario, seed);
          const double oracle = oracle_time(staged);
          ++count;
          std::printf("%s:", scenario.name().c_str());
          for (const char* policy : {"none", "diffusion", "greedy", "zoltan", "stealing"}) {
            const Outcome o =
                run_jobs(staged.cluster, staged.layout, staged.jobs, policy, {}, options_for(staged.cluster));
            CHECK(o.complete);
            std::printf(" %s %.3f", policy, o.time / oracle);
            log_ratio[policy] += std::log(o.time / oracle);
          }
          std::printf("\n");
        }
  for (const auto& [policy, sum] : log_ratio) {
    CAPTURE(policy);
    const double mean = std::exp(sum / count);
    std::printf("%s takes %.3f of the oracle's time\n", policy.c_str(), mean);
    if (policy != "none") CHECK(mean < 1.5);
  }
}
