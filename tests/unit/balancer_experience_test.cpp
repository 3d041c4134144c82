#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "balancer/cost/move_cost.hpp"
#include "balancer/snapshot/experience.hpp"
#include "balancer/trigger/outlook.hpp"
#include "property/cases.hpp"
#include "support/id_literals.hpp"
#include "support/load_snapshots.hpp"

using namespace driftmesh;
using namespace driftmesh::balancer;
using namespace driftmesh::testing;

namespace {

void finish(Experience& experience, bool on_segments, double forecast, double made, double seconds) {
  experience.worked(0_sub, seconds, true);
  experience.finished(0_sub, on_segments, forecast, made);
}

/// Subdomains whose triangles and times deviate from the forecast by normal factors.
Experience experience_of(std::mt19937_64& random, int count, double ratio, double deviation) {
  std::normal_distribution<double> normal(0, deviation);
  Experience experience;
  for (int i = 0; i < count; ++i) {
    const double made = 1000 * ratio * std::max(0.1, 1 + normal(random));
    finish(experience, true, 1000, made, (kWorkToStart + made) * 1e-6);
  }
  return experience;
}

std::vector<ReportedLoad> equal_loads(int count) {
  return std::vector<ReportedLoad>(static_cast<std::size_t>(count), ReportedLoad{0_sub, 0, 1000, 0});
}

}  // namespace

TEST_CASE("the expected rest is what is missing, and never nothing") {
  CHECK(expected_rest(1000, 0, 400) == 600);
  CHECK(expected_rest(1000, 0, 1400) == 0);
  CHECK(expected_rest(1000, 100, 0) == doctest::Approx(1000));
  CHECK(expected_rest(1000, 100, 1000) == doctest::Approx(100 * std::sqrt(2 / 3.14159265)));
  double last = HUGE_VAL;
  for (double made = 0; made < 5000; made += 50) {
    const double rest = expected_rest(1000, 100, made);
    CHECK(rest > 0);
    CHECK(rest <= last);
    CHECK(rest >= 1000 - made);
    last = rest;
  }
}

TEST_CASE("without experience forecasts hold") {
  const Experience none;
  CHECK(none.ratio(true) == 1);
  CHECK(none.ratio(false) == 1);
  CHECK(none.rest(true, 5000, 0) == doctest::Approx(5000 + kWorkToStart));
  CHECK(none.doubt({}) == 0);
  CHECK(none.doubt(equal_loads(1)) > none.doubt(equal_loads(100)));
}

TEST_CASE("ratios are learned by kind, and tend to that of all where little is known") {
  Experience experience;
  for (int i = 0; i < 40; ++i) finish(experience, true, 1000, 2000, 2e-3);
  CHECK(experience.ratio(true) == doctest::Approx(2).epsilon(0.03));
  CHECK(experience.ratio(false) > 1.5);  // the best guess
  for (int i = 0; i < 40; ++i) finish(experience, false, 1000, 1000, 1e-3);
  CHECK(experience.ratio(true) == doctest::Approx(2).epsilon(0.05));
  CHECK(experience.ratio(false) == doctest::Approx(1).epsilon(0.05));
}

TEST_CASE("a single subdomain changes the ratio by a part of its deviation") {
  Experience experience;
  finish(experience, true, 1000, 4000, 4e-3);
  CHECK(experience.ratio(true) > 1);
  CHECK(experience.ratio(true) < 4);
}

TEST_CASE("of subdomains started elsewhere nothing is learned") {
  Experience experience;
  experience.worked(1_sub, 1, false);
  experience.finished(1_sub, true, 1000, 3000);
  CHECK(experience.ratio(true) == 1);
  experience.worked(2_sub, 1, true);
  experience.left(2_sub);
  experience.finished(2_sub, true, 1000, 3000);
  CHECK(experience.ratio(true) == 1);
}

TEST_CASE("the time of a subdomain is that of all slices since it last began") {
  const auto variation = [](const auto& work_on_first) {
    Experience experience;
    work_on_first(experience);
    experience.finished(1_sub, true, 1000, 1000);
    finish(experience, true, 1000, 1000, 2);
    return experience.variation();
  };
  const double at_once = variation([](Experience& e) { e.worked(1_sub, 6, true); });
  CHECK(variation([](Experience& e) {
          e.worked(1_sub, 1, true);
          e.worked(2_sub, 7, true);
          e.worked(1_sub, 3, false);
          e.worked(1_sub, 2, false);
        }) == doctest::Approx(at_once));
  CHECK(variation([](Experience& e) {
          e.worked(1_sub, 50, true);
          e.worked(1_sub, 4, true);
          e.worked(1_sub, 2, false);
        }) == doctest::Approx(at_once));
  // Paces 6 and 2, of mean 4, deviate by half of it; two subdomains that vary by a tenth are supposed.
  CHECK(at_once == doctest::Approx(std::sqrt((2 * 0.01 + 2 * 0.25) / 4)));
}

TEST_CASE("a start takes as long as some triangles: small subdomains are no slower than they should be") {
  Experience experience(400);
  for (const double forecast : {100.0, 1000.0, 5000.0, 20000.0})
    finish(experience, forecast < 2000, forecast, forecast, (400 + forecast) * 1e-6);
  CHECK(experience.variation() == doctest::Approx(std::sqrt(2 * 0.01 / 6)));
  CHECK(experience.rest(true, 5000, 0) == doctest::Approx(5400));
  CHECK(experience.rest(true, 5000, 100) == doctest::Approx(4900));
}

TEST_CASE("what took no time, or was to have no triangles, says nothing") {
  Experience experience;
  finish(experience, true, 1000, 3000, 0);
  finish(experience, true, 0, 3000, 1);
  experience.finished(4_sub, true, 1000, 3000);
  CHECK(experience.ratio(true) == 1);
  CHECK(experience.variation() == Experience().variation());
}

TEST_CASE("the rest of what has exceeded its forecast is that of a normal distribution") {
  // By adding up the tail beyond what is made, instead of by its formula.
  for (const double made : {700.0, 1000.0, 1150.0, 1400.0}) {
    CAPTURE(made);
    double beyond = 0, weight = 0;
    for (double x = made + 0.05; x < 2000; x += 0.1) {
      const double density = std::exp(-(x - 1000) * (x - 1000) / (2 * 100.0 * 100.0));
      beyond += density * (x - made);
      weight += density;
    }
    CHECK(expected_rest(1000, 100, made) == doctest::Approx(beyond / weight).epsilon(1e-4));
  }
}

TEST_CASE("ratio and variation approach those of the subdomains") {
  std::mt19937_64 random = seeded_generator("experience");
  for (std::int64_t i = 0; i < case_count(50); ++i) {
    const double ratio = std::exp(std::uniform_real_distribution<double>(-1, 1)(random));
    const double deviation = std::uniform_real_distribution<double>(0, 0.3)(random);
    const Experience experience = experience_of(random, 1000, ratio, deviation);
    CHECK(experience.ratio(true) == doctest::Approx(ratio).epsilon(0.05));
    const double part = 1000 * ratio / (1000 * ratio + kWorkToStart);  // fraction of the time that varies
    CHECK(std::abs(experience.variation() - deviation * part) < 0.03);
    CHECK(experience.doubt(equal_loads(1)) >= experience.variation());
    CHECK(experience.doubt(equal_loads(100)) < 0.2 * experience.variation());
  }
}

TEST_CASE("noise explains small gains, and little of large ones") {
  CHECK(gain_beyond(0, 0.5) == 0.5);
  CHECK(gain_beyond(1, 0.9) == 0);
  CHECK(gain_beyond(1, 1.4) == 0);
  CHECK(gain_beyond(1, -100) == 0);
  CHECK(gain_beyond(1, 100) == doctest::Approx(99).epsilon(0.01));
}

TEST_CASE("what forecasts leave in doubt moves nothing") {
  // One of two ranks seems to have a tenth more than the other.
  LoadSnapshot s = initial_snapshot(grid_layout(42, 1, 2), {1000, 1000});
  for (SubdomainLoad& load : s.subdomains) load.owner = load.id < 22_sub ? 0_rank : 1_rank;
  sum_up(s);
  const std::vector<Move> plan{{21_sub, 1_rank}};
  CHECK(outlook(s, {}, 0) == Verdict::kDone);
  CHECK(worth_moving(s, plan, {}) == plan);
  for (RankLoad& rank : s.ranks) rank.doubt = 0.01;
  CHECK(outlook(s, {}, 0) == Verdict::kDone);
  CHECK(worth_moving(s, plan, {}) == plan);
  for (RankLoad& rank : s.ranks) rank.doubt = 0.1;
  CHECK(outlook(s, {}, 0) != Verdict::kDone);
  CHECK(worth_moving(s, plan, {}).empty());
  s.ranks[1_rank].remaining = 0;  // plainly idle
  CHECK(outlook(s, {}, 0) == Verdict::kDone);
}

TEST_CASE("the noise of ranks that differ by chance alone is the gain that they seem to offer") {
  std::mt19937_64 random = seeded_generator("noise");
  for (const std::int32_t ranks : {2, 4, 16, 144}) {
    constexpr double kDoubt = 0.05;
    std::normal_distribution<double> time(1, kDoubt);
    double gain = 0, noise = 0;
    for (int i = 0; i < 4000; ++i) {
      LoadSnapshot s;
      for (std::int32_t r = 0; r < ranks; ++r) s.ranks.push_back({1, time(random), kDoubt});
      gain += finishing_time(s) - ideal_time(s);
      noise += noise_of(s);
    }
    CHECK(noise == doctest::Approx(gain).epsilon(0.1));
  }
}
