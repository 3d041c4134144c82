#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <ranges>
#include <string>
#include <vector>

#include "support/balanced_ranks.hpp"

namespace driftmesh::testing {

/// How the forecasts of a scenario are wrong: each subdomain for itself, or a whole quarter of the domain alike, as
/// where a coast runs through it.
enum class Errors { kScattered, kClustered };
/// Who has which subdomains at the start: neighbors together, equal forecasts for each rank; or dealt out in turn.
enum class Start { kCompact, kRoundRobin };

/// A cluster and work for it: what a user may run, good or bad for balancing.
struct BalancingScenario {
  std::int32_t ranks = 4;
  int per_rank = 20;       ///< subdomains
  double speed_ratio = 1;  ///< speed of the fastest rank over that of the slowest
  double latency = 50e-6;  ///< seconds
  double error = 1;        ///< work is the forecast times or divided by up to this
  Errors errors = Errors::kScattered;
  Start start = Start::kCompact;
  double seconds = 2;  ///< time that it takes at best

  [[nodiscard]] std::string name() const;
};

inline std::string BalancingScenario::name() const {
  char text[200];
  std::snprintf(text, sizeof text,
                "%3d ranks, %3d subdomains each, speeds 1:%-2g, %5g ms, forecasts off by %g%s, %s, %g s", ranks,
                per_rank, speed_ratio, 1e3 * latency, error, errors == Errors::kClustered ? " in a corner" : "",
                start == Start::kRoundRobin ? "round robin" : "compact", seconds);
  return text;
}

/// The cluster, subdomains and work of a scenario; the same seed gives the same ones.
struct Staged {
  Cluster cluster;
  Layout layout;
  Jobs jobs;
};

inline Staged stage(const BalancingScenario& scenario, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto unit = [&] { return std::uniform_real_distribution<double>(0, 1)(random); };
  constexpr double kMeanSpeed = 1e6;

  Staged staged;
  staged.cluster.latency = scenario.latency;
  for (const int r : std::views::iota(0, scenario.ranks)) {
    const double place = scenario.ranks == 1 ? 0 : static_cast<double>(r) / (scenario.ranks - 1);
    staged.cluster.speeds.push_back(std::pow(scenario.speed_ratio, place));
  }
  std::ranges::shuffle(staged.cluster.speeds, random);
  double total = 0;
  for (const double s : staged.cluster.speeds) total += s;
  for (double& s : staged.cluster.speeds) s *= kMeanSpeed * scenario.ranks / total;

  const int count = scenario.ranks * scenario.per_rank;
  const int columns = std::max(1, static_cast<int>(std::sqrt(count)));
  staged.layout = grid_layout(columns, count / columns, scenario.ranks);
  Layout& layout = staged.layout;
  double forecast = 0;
  for (auto& s : layout.subdomains) forecast += s.predicted = std::exp(unit() - 0.5);
  double before = 0;
  int turn = 0;
  for (auto& s : layout.subdomains) {
    s.owner =
        scenario.start == Start::kRoundRobin
            ? static_cast<Rank>(turn++ % scenario.ranks)
            : static_cast<Rank>(std::min(scenario.ranks - 1, static_cast<int>(before / forecast * scenario.ranks)));
    before += s.predicted;
  }
  std::vector<double> factors;
  for (const auto& s : layout.subdomains) {
    const bool in_corner = s.x < columns / 2.0 && s.y < columns / 2.0;
    const double scattered = std::pow(scenario.error, 2 * unit() - 1);
    factors.push_back(scenario.errors == Errors::kScattered ? scattered
                      : in_corner                           ? scenario.error * std::sqrt(scattered)
                                                            : 1);
  }
  double work = 0;
  for (const SubdomainId i : ids_of(layout.subdomains)) work += layout.subdomains[i].predicted * factors[to_index(i)];
  const double scale = scenario.seconds * kMeanSpeed * scenario.ranks / work;
  for (const SubdomainId i : ids_of(layout.subdomains)) {
    double& predicted = layout.subdomains[i].predicted;
    predicted *= scale;
    staged.jobs.push_back({0, std::floor(predicted * factors[to_index(i)]), predicted});
  }
  return staged;
}

/// Forty of them: every value of each property, in combinations that differ much from each other.
inline std::vector<BalancingScenario> balancing_scenarios() {
  constexpr std::array kRanks{2, 4, 16, 48};
  constexpr std::array kPerRank{4, 20, 60};
  constexpr std::array kRatios{1.0, 3.0, 10.0};
  constexpr std::array kLatencies{50e-6, 1e-3, 10e-3};
  constexpr std::array kErrors{1.0, 1.5, 4.0};
  constexpr std::array kSeconds{0.3, 2.0, 10.0};
  std::vector<BalancingScenario> scenarios;
  for (std::size_t i = 0; i < 36; ++i)
    scenarios.push_back({kRanks[i % 4], kPerRank[i / 4 % 3], kRatios[(i + i / 12) % 3], kLatencies[(i / 2 + i / 9) % 3],
                         kErrors[(i + i / 4) % 3], i % 5 < 2 ? Errors::kClustered : Errors::kScattered,
                         i % 7 < 2 ? Start::kRoundRobin : Start::kCompact, kSeconds[(i / 3) % 3]});
  scenarios.push_back({4, 50, 1, 50e-6, 4, Errors::kClustered, Start::kCompact, 1});     // a coast
  scenarios.push_back({4, 50, 1, 50e-6, 4, Errors::kClustered, Start::kRoundRobin, 1});  // the same, dealt out
  scenarios.push_back({16, 20, 1, 50e-6, 1, Errors::kScattered, Start::kCompact, 2});    // nothing to balance
  scenarios.push_back({32, 20, 1, 10e-3, 1, Errors::kScattered, Start::kCompact, 1});    // nothing, and a slow network
  return scenarios;
}

}  // namespace driftmesh::testing
