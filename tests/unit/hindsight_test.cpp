#include "cluster/hindsight.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <random>
#include <vector>

#include "support/id_literals.hpp"

using namespace driftmesh;

namespace {

/// The best of all assignments.
double best_time(const IdVector<SubdomainId, double>& work, const IdVector<Rank, double>& speeds) {
  IdVector<Rank, double> load(speeds.size(), 0);
  double best = 1e300;
  const std::function<void(std::size_t)> assign = [&](std::size_t i) {
    if (i == work.size()) {
      double last = 0;
      for (const Rank r : ids_of(speeds)) last = std::max(last, load[r] / speeds[r]);
      best = std::min(best, last);
      return;
    }
    const double w = work[static_cast<SubdomainId>(i)];
    for (const Rank r : ids_of(speeds)) {
      load[r] += w;
      assign(i + 1);
      load[r] -= w;
    }
  };
  assign(0);
  return best;
}

}  // namespace

TEST_CASE("the oracle is no better than the best assignment, and not much worse") {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0.1, 1);
  for (int i = 0; i < 200; ++i) {
    IdVector<SubdomainId, double> work;
    IdVector<Rank, double> speeds;
    for (std::uint64_t n = 1 + random() % 7; n > 0; --n) work.push_back(unit(random));
    for (std::uint64_t n = 1 + random() % 3; n > 0; --n) speeds.push_back(unit(random));
    const double best = best_time(work, speeds), oracle = oracle_seconds(work, speeds, {});
    CHECK(oracle >= best * (1 - 1e-12));
    CHECK(oracle <= best * 5 / 3);  // Friesen 1987, for machines of different speeds
    const IdVector<Rank, protocol::SpeedSchedule> steady(speeds.size(), protocol::SpeedSchedule());
    CHECK(oracle_seconds(work, speeds, steady) == doctest::Approx(oracle));
  }
}

TEST_CASE("the oracle knows when speeds change") {
  const IdVector<SubdomainId, double> work{4, 2, 2};
  const IdVector<Rank, double> speeds{1, 1};
  CHECK(oracle_seconds(work, speeds, {}) == 4);
  // The second rank is there from second 3 on: the first does six of eight, or four by second 4 and the other two by 5.
  const IdVector<Rank, protocol::SpeedSchedule> late{protocol::SpeedSchedule(),
                                                     protocol::SpeedSchedule({{0, 0}, {3, 1}})};
  CHECK(oracle_seconds(work, speeds, late) == 6);
}

TEST_CASE("the work on a subdomain is what its slices took, at the speed of that time") {
  ClusterRun run;
  run.owners.resize(2);
  run.samples = {{.time = 2, .rank = 0_rank, .worked = 2, .subdomain = 0_sub},
                 {.time = 2, .rank = 1_rank},
                 {.time = 5, .rank = 1_rank, .worked = 1, .subdomain = 0_sub},
                 {.time = 9, .rank = 1_rank, .worked = 4, .subdomain = 1_sub}};
  const IdVector<Rank, double> speeds{10, 100};
  CHECK(work_done(run, speeds, {}) == IdVector<SubdomainId, double>{120, 400});
  const IdVector<Rank, protocol::SpeedSchedule> halved{protocol::SpeedSchedule(), protocol::SpeedSchedule({{6, 0.5}})};
  CHECK(work_done(run, speeds, halved) == IdVector<SubdomainId, double>{120, 250});
}
