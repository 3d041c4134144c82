#pragma once

#include <functional>
#include <queue>
#include <utility>
#include <vector>

namespace driftmesh {

/// Lowers lengths until none exceeds the limit that a neighbor sets: Dijkstra's algorithm from all that lower another
/// one, since the shortest length is final. `lowering`: the length and the place of each of them, at least;
/// visit_neighbors(place, visit) calls visit(neighbor); limit(from, to) is what the length at `from` allows at `to`.
template <class Place, class Lengths, class VisitNeighbors, class Limit>
void lower_lengths(std::vector<std::pair<double, Place>> lowering, Lengths& lengths,
                   const VisitNeighbors& visit_neighbors, const Limit& limit) {
  using Entry = std::pair<double, Place>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue(std::greater<>{}, std::move(lowering));
  while (!queue.empty()) {
    const auto [length, place] = queue.top();
    queue.pop();
    if (length > lengths[place]) continue;
    visit_neighbors(place, [&, from = place](Place to) {
      const double allowed = limit(from, to);
      if (!(allowed < lengths[to])) return;
      lengths[to] = allowed;
      queue.emplace(allowed, to);
    });
  }
}

}  // namespace driftmesh
