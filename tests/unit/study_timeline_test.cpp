#include <doctest/doctest.h>

#include <algorithm>
#include <random>

#include "driftmesh/error.hpp"
#include "study/chrome_trace.hpp"
#include "study/timeline.hpp"
#include "support/id_literals.hpp"

using namespace driftmesh;
using namespace driftmesh::study;
using balancer::Deliberation;
using balancer::Verdict;

namespace {

/// The slice of a rank from `start` to `stop`.
LoadSample slice(Rank rank, double start, double stop, double left, std::int64_t triangles = 1) {
  return {stop, rank, triangles, left, stop - start, 0_sub};
}

Timeline timeline_of_run(const std::vector<LoadSample>& samples, std::vector<Deliberation> deliberations = {}) {
  ClusterRun run;
  run.samples = samples;
  run.deliberations = std::move(deliberations);
  return timeline_of(chrome_trace(run), "run.trace.json");
}

Deliberation considered(Deliberation::Subject subject, Verdict verdict, std::vector<balancer::JudgedMove> moves = {}) {
  return {.subject = subject, .verdict = verdict, .time = 0.5, .rank = 3_rank, .moves = std::move(moves)};
}

}  // namespace

TEST_CASE("slices join on a rank where the gap between them cannot be seen") {
  const Timeline timeline = timeline_of_run(
      {slice(0_rank, 0, 0.4, 8), slice(0_rank, 0.4001, 0.5, 7, 5), slice(1_rank, 0, 1, 9), slice(0_rank, 0.9, 1, 0)});
  REQUIRE(timeline.busy.size() == 3);
  CHECK(timeline.busy[0].rank == 0);
  CHECK(timeline.busy[0].start == doctest::Approx(0));
  CHECK(timeline.busy[0].stop == doctest::Approx(0.5));
  CHECK(timeline.busy[0].triangles == 5);
  CHECK(timeline.busy[1].start == doctest::Approx(0.9));
  CHECK(timeline.busy[2].rank == 1);
}

TEST_CASE("plans are told from looks, and what was made from what was rejected") {
  using Subject = Deliberation::Subject;
  const std::vector<balancer::JudgedMove> moves{{0_sub, 0_rank, 1_rank, Verdict::kDone},
                                                {1_sub, 0_rank, 1_rank, Verdict::kNeedless}};
  const Timeline timeline = timeline_of_run(
      {slice(0_rank, 0, 1, 1)},
      {considered(Subject::kLoad, Verdict::kEven), considered(Subject::kPlan, Verdict::kNoMoves),
       considered(Subject::kPlan, Verdict::kDone, moves), considered(Subject::kPlan, Verdict::kSmallSaving, moves),
       considered(Subject::kAdvice, Verdict::kDone, moves)});
  REQUIRE(timeline.plans.size() == 3);
  for (const Timeline::Plan& plan : timeline.plans) {
    CHECK(plan.rank == 3);
    CHECK(plan.time == doctest::Approx(0.5));
    CHECK(plan.moves == 1);
  }
  CHECK(timeline.plans[0].made);
  CHECK(!timeline.plans[1].made);
  CHECK(timeline.plans[2].made);
}

TEST_CASE("what is left over time is that of each rank's last slice, of random runs") {
  std::mt19937 random(20260711);
  for (int round = 0; round < 50; ++round) {
    std::vector<LoadSample> samples;
    const int ranks = 1 + static_cast<int>(random() % 5);
    for (int r = 0; r < ranks; ++r) {
      double time = 0;
      for (unsigned k = 0, slices = 1 + random() % 40; k < slices; ++k) {
        const double start = time + random() % 3, stop = start + 1 + random() % 4;
        samples.push_back(slice(Rank{r}, start, stop, static_cast<double>(random() % 1000)));
        time = stop;
      }
    }
    std::ranges::shuffle(samples, random);
    const Timeline timeline = timeline_of_run(samples);
    REQUIRE(timeline.load.size() == kLoadSamples + 1);
    for (const Timeline::Load& load : timeline.load) {
      CAPTURE(round);
      CAPTURE(load.time);
      double least = 1e9, most = 0, sum = 0;
      for (int r = 0; r < ranks; ++r) {
        const LoadSample* first = nullptr;
        const LoadSample* last = nullptr;
        for (const LoadSample& s : samples) {
          if (s.rank != Rank{r}) continue;
          if (!first || s.time < first->time) first = &s;
          if (s.time <= load.time + 1e-6 && (!last || s.time > last->time)) last = &s;
        }
        const double left = (last ? last : first)->remaining;
        least = std::min(least, left), most = std::max(most, left), sum += left;
      }
      // A moment that is that of a slice's end but for rounding is on either side of it.
      const bool at_an_end =
          std::ranges::any_of(samples, [&](const LoadSample& s) { return std::abs(s.time - load.time) < 1e-6; });
      if (at_an_end) continue;
      CHECK(load.least == doctest::Approx(least));
      CHECK(load.most == doctest::Approx(most));
      CHECK(load.mean == doctest::Approx(sum / ranks));
    }
  }
}

TEST_CASE("a run without slices has nothing to show, and what is not JSON is an error") {
  const Timeline timeline = timeline_of_run({});
  CHECK(timeline.busy.empty());
  CHECK(timeline.load.empty());
  CHECK_THROWS_AS(static_cast<void>(timeline_of("{\"traceEvents\": [", "cut.trace.json")), InputError);
}
