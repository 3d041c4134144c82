#include "balancer/planner/within_memory.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace driftmesh::balancer {
namespace {

constexpr double kRoom = 1.03;  // parts are rarely more uneven

}  // namespace

LoadSnapshot within_memory(LoadSnapshot snapshot) {
  const IdVector<Rank, double> speeds = assumed_speeds(snapshot.ranks);
  double work = 0, speed = 0;                       // sums over ranks not known to be short
  std::vector<std::pair<double, Rank>> by_seconds;  // time for the work that fits in a rank's memory
  for (const Rank r : ids_of(speeds)) {
    RankLoad& rank = snapshot.ranks[r];
    const double most = std::max(rank.remaining, (rank.remaining + std::max(0.0, rank.free_memory)) / kRoom);
    by_seconds.emplace_back(most / speeds[r], r);
    rank.speed = speeds[r];
    work += rank.remaining;
    speed += speeds[r];
  }
  std::ranges::sort(by_seconds);
  std::size_t short_of_it = 0;
  for (; short_of_it < by_seconds.size(); ++short_of_it) {
    const auto [seconds, r] = by_seconds[short_of_it];
    if (seconds * speed >= work || short_of_it + 1 == by_seconds.size()) break;
    work -= seconds * speeds[r];
    speed -= speeds[r];
  }
  IdVector<Rank, bool> is_short(speeds.size(), false);
  for (std::size_t i = 0; i < short_of_it; ++i) {
    const auto [seconds, r] = by_seconds[i];
    snapshot.ranks[r].speed *= seconds * speed / work;
    is_short[r] = true;
  }
  for (SubdomainLoad& s : snapshot.subdomains) s.fixed = s.fixed || is_short[s.owner];
  return snapshot;
}

}  // namespace driftmesh::balancer
