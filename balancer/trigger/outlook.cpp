#include "balancer/trigger/outlook.hpp"

#include <algorithm>
#include <vector>

namespace driftmesh::balancer {
namespace {

/// Whether any rank that can be given some has no more work than it does in this many seconds.
bool runs_out(const LoadSnapshot& snapshot, double seconds) {
  const IdVector<Rank, double> speeds = assumed_speeds(snapshot.ranks);
  return std::ranges::any_of(ids_of(speeds), [&](Rank r) {
    const RankLoad& rank = snapshot.ranks[r];
    return rank.free_memory > 0 && rank.remaining <= seconds * speeds[r];
  });
}

}  // namespace

Verdict outlook(const LoadSnapshot& snapshot, const Worth& worth, double cost_of_planning, double ahead) {
  const double last = finishing_time(snapshot), ideal = ideal_time(snapshot), noise = noise_of(snapshot);
  const double gain = gain_beyond(noise, last - ideal);
  const Verdict verdict = gain <= 0                                            ? Verdict::kEven
                          : gain <= worth.gain * last || gain <= worth.seconds ? Verdict::kSmallGain
                          : !runs_out(snapshot, ahead)                         ? Verdict::kTooEarly
                          : gain <= cost_of_planning                           ? Verdict::kCostlyPlanning
                                                                               : Verdict::kDone;
  if (is_logged())
    note({.verdict = verdict,
          .finish = last,
          .ideal = ideal,
          .noise = noise,
          .saves = gain,
          .loads = verdict == Verdict::kTooEarly ? std::vector<Deliberation::KnownLoad>{} : known_loads(snapshot)});
  return verdict;
}

}  // namespace driftmesh::balancer
