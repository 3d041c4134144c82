#include "cluster/hindsight.hpp"

#include <algorithm>
#include <functional>
#include <vector>

namespace driftmesh {

IdVector<SubdomainId, double> work_done(const ClusterRun& run, const IdVector<Rank, double>& speeds,
                                        const IdVector<Rank, protocol::SpeedSchedule>& schedules) {
  IdVector<SubdomainId, double> work(run.owners.size(), 0);
  for (const LoadSample& s : run.samples) {
    if (s.worked <= 0) continue;
    const double seconds =
        schedules.empty() ? s.worked : schedules[s.rank].done_by(s.time) - schedules[s.rank].done_by(s.time - s.worked);
    work[s.subdomain] += seconds * speeds[s.rank];
  }
  return work;
}

double oracle_seconds(const IdVector<SubdomainId, double>& work, const IdVector<Rank, double>& speeds,
                      const IdVector<Rank, protocol::SpeedSchedule>& schedules) {
  std::vector<double> largest_first(work.begin(), work.end());
  std::ranges::sort(largest_first, std::greater());
  IdVector<Rank, double> load(speeds.size(), 0);
  const auto finish = [&](Rank r, double more) {
    const double seconds = (load[r] + more) / speeds[r];
    return schedules.empty() ? seconds : schedules[r].end_of(0, seconds);
  };
  double last = 0;
  for (const double w : largest_first) {
    Rank best{0};
    double earliest = finish(best, w);
    for (const Rank r : ids_of(speeds))
      if (const double finished = finish(r, w); finished < earliest) best = r, earliest = finished;
    load[best] += w;
    last = std::max(last, earliest);
  }
  return last;
}

}  // namespace driftmesh
