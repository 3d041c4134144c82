#include "balancer/planner/draft.hpp"

#include <algorithm>
#include <numeric>

#include "balancer/snapshot/effort.hpp"

namespace driftmesh::balancer {

Draft::Draft(const LoadSnapshot& before, std::span<const Move> moves, const MoveCost& cost)
    : before_(before), held_(before.ranks.size()), last_change_(before.ranks.size(), 0) {
  note_effort("border", static_cast<double>(before.subdomains.size()));
  const IdVector<Rank, double> speeds = assumed_speeds(before.ranks);
  for (const Rank r : ids_of(speeds)) {
    slowness_.push_back(1 / speeds[r]);
    free_memory_.push_back(before.ranks[r].free_memory);
    times_.push_back(before.ranks[r].remaining / speeds[r]);
  }
  for (const SubdomainLoad& s : before.subdomains) {
    if (!s.fixed) held_[s.owner].push_back(static_cast<Index>(owners_.size()));
    owners_.push_back(s.owner);
    const double packing = cost.for_giver(s.bytes, 1);
    efforts_.push_back({s.remaining, packing, cost.for_taker(s.bytes, 1) - packing});
  }
  add_borders();
  for (const Move& move : moves) {
    const SubdomainLoad* const s = find(before, move.subdomain);
    if (s != nullptr && !s->fixed && slowness_.has(move.destination))
      put(static_cast<Index>(s - before.subdomains.data()), move.destination);
  }
}

void Draft::add_borders() {
  IdVector<SubdomainId, Index> index(before_.layout->subdomains.size(), kNone);
  for (Index i = 0; i < size(); ++i) index[load(i).id] = i;
  for (Index i = 0; i < size(); ++i) {
    first_border_.push_back(borders_.size());
    for (const Neighbor& n : (*before_.layout)[load(i).id].neighbors)
      if (const Index j = index[n.subdomain]; j != kNone && is_open_border(before_, load(i), load(j)))
        borders_.push_back({j, n.length});
  }
  first_border_.push_back(borders_.size());
}

void Draft::make(const Change& change) {
  const Rank from = owner(change.goes);
  put(change.goes, change.to);
  if (change.comes != kNone) put(change.comes, from);
}

void Draft::put(Index i, Rank to) {
  const auto settle = [&](int sign) {
    const Rank r = owner(i);
    last_change_[r] = changes_;
    times_[r] += sign * seconds(i, r);
    if (has_moved(i)) free_memory_[r] -= sign * memory_for(load(i));
  };
  ++changes_;
  settle(-1);
  if (has_moved(i)) --moves_;
  std::erase(held_[owner(i)], i);
  owners_[i] = to;
  held_[to].push_back(i);
  if (has_moved(i)) ++moves_;
  settle(+1);
}

std::vector<Move> Draft::list() const {
  std::vector<Move> moves;
  for (Index i = 0; i < size(); ++i)
    if (has_moved(i)) moves.push_back({load(i).id, owner(i)});
  return moves;
}

double Draft::mean_border() const {
  const double sum = std::accumulate(borders_.begin(), borders_.end(), 0.0,
                                     [](double lengths, const Border& b) { return lengths + b.length; });
  return borders_.empty() ? 0 : sum / static_cast<double>(borders_.size());
}

std::vector<Rank> Draft::ranks_around(Index i) const {
  std::vector<Rank> ranks;
  for (const Border& b : borders(i))
    if (const Rank r = owner(b.beyond); r != owner(i) && std::ranges::find(ranks, r) == ranks.end()) ranks.push_back(r);
  return ranks;
}

/// Whether there is memory for `i` once `leaves` has left.
bool Draft::fits(Index i, Rank to, Index leaves) const {
  if (i == kNone || to == home(i)) return true;
  const double freed = leaves != kNone && has_moved(leaves) ? memory_for(load(leaves)) : 0;
  return memory_for(load(i)) <= free_memory_[to] + freed;
}

double Draft::more_border(Index i, Rank to) const {
  double more = 0;
  for (const Border& b : borders(i)) {
    if (owner(b.beyond) == owner(i)) more += b.length;
    if (owner(b.beyond) == to) more -= b.length;
  }
  return more;
}

Draft::Change Draft::in_exchange(Change change, Index j) const {
  if (j == kNone) return change;
  change.comes = j;
  change.border += more_border(j, owner(change.goes));
  // Both have counted on the other one to stay where it is.
  for (const Border& b : borders(change.goes))
    if (b.beyond == j) change.border += 2 * b.length;
  change.saved += moves_saved(j, owner(change.goes));
  return change;
}

}  // namespace driftmesh::balancer
