#pragma once

#include <algorithm>
#include <cmath>
#include <random>

#include "driftmesh/load_snapshot.hpp"

namespace driftmesh::testing {

using balancer::Layout;
using balancer::LoadSnapshot;

/// A grid of columns x rows equal subdomains, mapped to the ranks in blocks of consecutive ones.
inline Layout grid_layout(int columns, int rows, std::int32_t ranks) {
  Layout layout;
  layout.ranks = ranks;
  const int count = columns * rows;
  for (int i = 0; i < count; ++i) {
    const int x = i % columns, y = i / columns;
    Layout::Subdomain s;
    s.x = x + 0.5;
    s.y = y + 0.5;
    s.predicted = 1000;
    s.owner = static_cast<Rank>(static_cast<std::int64_t>(i) * ranks / count);
    for (const auto& [dx, dy] : {std::pair(0, -1), {-1, 0}, {1, 0}, {0, 1}})
      if (x + dx >= 0 && x + dx < columns && y + dy >= 0 && y + dy < rows)
        s.neighbors.push_back({static_cast<SubdomainId>(i + dx + dy * columns), 1.0});
    layout.subdomains.push_back(std::move(s));
  }
  return layout;
}

/// All subdomains of the layout at their owners, with the predicted work, at these speeds.
inline LoadSnapshot initial_snapshot(Layout layout, const IdVector<Rank, double>& speeds) {
  LoadSnapshot snapshot;
  IdVector<Rank, std::int32_t> turns(speeds.size(), 0);
  for (const SubdomainId i : ids_of(layout.subdomains)) {
    const Rank owner = layout.subdomains[i].owner;
    snapshot.subdomains.push_back({i, owner, layout[i].predicted, 100, turns[owner]++});
  }
  for (const double speed : speeds) snapshot.ranks.push_back({speed, 0});
  snapshot.layout = std::make_shared<Layout>(std::move(layout));
  balancer::sum_up(snapshot);
  return snapshot;
}

/// Ranks of unequal speeds (some unknown), subdomains of unequal work (some finished and not listed), owners at random:
/// anything from one rank and no work to many more ranks than subdomains.
inline LoadSnapshot random_snapshot(std::mt19937_64& random) {
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<std::uint64_t>(n)); };
  const auto unit = [&] { return std::uniform_real_distribution<double>(0, 1)(random); };
  const std::int32_t ranks = 1 + below(below(4) == 0 ? 40 : 8);
  Layout layout = grid_layout(1 + below(12), 1 + below(12), ranks);
  for (auto& s : layout.subdomains) {
    s.predicted = std::exp(8 * unit());
    if (below(3) == 0) s.owner = Rank{below(ranks)};
  }
  IdVector<Rank, double> speeds;
  while (speeds.size() < to_index(ranks)) speeds.push_back(below(8) == 0 ? 0 : std::exp(3 * unit()));
  LoadSnapshot snapshot = initial_snapshot(std::move(layout), speeds);
  const int finished = below(3) == 0 ? 100 : below(100);
  std::erase_if(snapshot.subdomains, [&](const auto&) { return below(100) < finished && below(2) == 0; });
  if (below(20) == 0) snapshot.subdomains.clear();
  for (auto& s : snapshot.subdomains) {
    s.remaining *= unit();
    s.bytes = below(2) == 0 ? 40 : static_cast<std::uint64_t>(below(1'000'000));
  }
  balancer::sum_up(snapshot);
  return snapshot;
}

/// The finishing time of the last rank, from the raw lists: an oracle that shares nothing with the planners.
inline double time_with(const LoadSnapshot& snapshot, const std::vector<balancer::Move>& moves) {
  double sum = 0;
  int known = 0;
  for (const auto& rank : snapshot.ranks)
    if (rank.speed > 0) sum += rank.speed, ++known;
  IdVector<Rank, double> work(snapshot.ranks.size(), 0.0);
  for (const auto& s : snapshot.subdomains) {
    Rank owner = s.owner;
    for (const auto& move : moves)
      if (move.subdomain == s.id) owner = move.destination;
    work[owner] += s.remaining;
  }
  double last = 0;
  for (const Rank r : ids_of(work)) {
    const double speed = snapshot.ranks[r].speed > 0 ? snapshot.ranks[r].speed : known > 0 ? sum / known : 1;
    last = std::max(last, work[r] / speed);
  }
  return last;
}

}  // namespace driftmesh::testing
