#include "cluster/cluster_run.hpp"

#include <numeric>

namespace driftmesh {
namespace {

template <class Value>
Value sum_of(const std::vector<RankOutcome>& ranks, Value RankOutcome::*member) {
  return std::accumulate(ranks.begin(), ranks.end(), Value{},
                         [=](Value sum, const RankOutcome& rank) { return sum + rank.*member; });
}

}  // namespace

std::int64_t ClusterRun::triangles() const {
  return sum_of(ranks, &RankOutcome::triangles);
}

std::uint64_t ClusterRun::messages() const {
  return sum_of(ranks, &RankOutcome::messages);
}

std::uint64_t ClusterRun::message_bytes() const {
  return sum_of(ranks, &RankOutcome::message_bytes);
}

double ideal_seconds(const ClusterRun& run, const IdVector<Rank, double>& speeds) {
  double work = 0;
  for (const Rank r : ids_of(run.ranks)) work += run.ranks[r].times.computing * speeds[r];
  return work / std::accumulate(speeds.begin(), speeds.end(), 0.0);
}

double ideal_seconds(const ClusterRun& run, const IdVector<Rank, double>& speeds,
                     const IdVector<Rank, protocol::SpeedSchedule>& schedules) {
  double work = 0;
  for (const LoadSample& s : run.samples)
    if (s.worked > 0)
      work += speeds[s.rank] * (schedules[s.rank].done_by(s.time) - schedules[s.rank].done_by(s.time - s.worked));
  const auto done_by = [&](double time) {
    double done = 0;
    for (const Rank r : ids_of(speeds)) done += speeds[r] * schedules[r].done_by(time);
    return done;
  };
  double early = 0, late = run.makespan;
  for (int halvings = 0; halvings < 60; ++halvings) {
    const double middle = early + (late - early) / 2;
    (done_by(middle) < work ? early : late) = middle;
  }
  return late;
}

}  // namespace driftmesh
