#include "balancer/mend_plan.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <queue>
#include <set>
#include <utility>
#include <vector>

#include "balancer/draft.hpp"

namespace driftmesh::balancer {
namespace {

using OptionalChange = std::optional<Draft::Change>;

/// All ranks, in the order in which they finish.
using RanksInOrder = std::set<std::pair<double, Rank>>;

/// Adjacent ranks, and some that finish first.
std::vector<Rank> helpers_of(const Draft& draft, Rank rank, const RanksInOrder& ranks) {
  constexpr std::size_t kIdlest = 8;
  std::vector<Rank> helpers;
  for (auto r = ranks.begin(); r != ranks.end() && helpers.size() < kIdlest; ++r) helpers.push_back(r->second);
  for (const Draft::Index i : draft.held_by(rank))
    for (const Rank r : draft.ranks_around(i))
      if (std::ranges::find(helpers, r) == helpers.end()) helpers.push_back(r);
  std::erase(helpers, rank);
  return helpers;
}

/// The change that costs least border for each second by which `rank` and its helper are less late, together. It must
/// take off a tenth of what the rank is late, and neither may finish later than the rank does now. Where nobody can be
/// in time little changes: evening out what is late would cost border for nothing, as such a plan is not made.
OptionalChange relief(const Draft& draft, Rank rank, double latest, const std::vector<Rank>& helpers) {
  constexpr double kLeast = 0.1;
  const auto late = [&](double finish) { return std::max(0.0, finish - latest); };
  const double now = draft.times()[rank];
  OptionalChange best;
  double best_price = HUGE_VAL;
  const auto consider = [&](double here, double there, Draft::Index i, Rank to, Draft::Index j) {
    const double gain = late(now) + late(draft.times()[to]) - late(here) - late(there);
    if (gain < kLeast * late(now) || std::max(here, there) >= now || !draft.has_memory(i, to, j)) return;
    Draft::Change change = draft.change(i, to);
    if (j != Draft::kNone) change = draft.in_exchange(change, j);
    const double price = change.border / gain;
    if (price >= best_price) return;
    best_price = price;
    best = change;
  };
  for (const Rank to : helpers)
    for (const Draft::Index i : draft.held_by(rank)) {
      const double here = now - draft.seconds(i, rank), there = draft.times()[to] + draft.seconds(i, to);
      consider(here, there, i, to, Draft::kNone);
      for (const Draft::Index j : draft.held_by(to))
        consider(here + draft.seconds(j, rank), there - draft.seconds(j, to), i, to, j);
    }
  return best;
}

void relieve_late_ranks(Draft& draft, double latest) {
  constexpr std::size_t kChanges = 4;  // to a rank, on average
  RanksInOrder ranks;
  for (const Rank r : ids_of(draft.times())) ranks.emplace(draft.times()[r], r);
  note_effort("search", static_cast<double>(ranks.size()));
  for (std::size_t rounds = kChanges * ranks.size(); rounds > 0 && ranks.rbegin()->first > latest; --rounds) {
    const Rank last = ranks.rbegin()->second;
    const auto change = relief(draft, last, latest, helpers_of(draft, last, ranks));
    if (!change) return;
    const auto changing = {last, change->to};
    for (const Rank r : changing) ranks.erase({draft.times()[r], r});
    draft.make(*change);
    for (const Rank r : changing) ranks.emplace(draft.times()[r], r);
  }
}

/// Calls visit(change) for each change that takes `i` to another rank, alone or in exchange for one that has come
/// there, and lets both ranks finish by `latest`, or no later than without it.
template <class Visit>
void for_each_change(const Draft& draft, Draft::Index i, Rank to, double latest, const Visit& visit) {
  const Rank from = draft.owner(i);
  const double from_now = draft.times()[from], to_now = draft.times()[to];
  const double here = from_now - draft.seconds(i, from), there = to_now + draft.seconds(i, to);
  const double here_latest = std::max(from_now, latest), there_latest = std::max(to_now, latest);
  const Draft::Change alone = draft.change(i, to);
  if (there <= there_latest && draft.has_memory(i, to, Draft::kNone)) visit(alone);
  for (const Draft::Index j : draft.held_by(to))
    if (draft.has_moved(j) && here + draft.seconds(j, from) <= here_latest &&
        there - draft.seconds(j, to) <= there_latest && draft.has_memory(i, to, j))
      visit(draft.in_exchange(alone, j));
}

/// The cheapest way for each subdomain to return.
class Returns {
 public:
  Returns(const Draft& draft, double latest) : draft_(draft), latest_(latest), known_(draft.size()) {}

  OptionalChange of(Draft::Index i) {
    if (!draft_.has_moved(i)) return std::nullopt;
    Known& known = known_[i];
    const std::uint64_t last = std::max(draft_.last_change(draft_.home(i)), draft_.last_change(draft_.owner(i)));
    if (known.when >= last) return known.cheapest;
    known = {draft_.changes(), std::nullopt};
    for_each_change(draft_, i, draft_.home(i), latest_, [&](const Draft::Change& change) {
      if (!known.cheapest || change.border_for_a_move() < known.cheapest->border_for_a_move()) known.cheapest = change;
    });
    return known.cheapest;
  }

 private:
  struct Known {
    std::uint64_t when = 0;
    OptionalChange cheapest;
  };

  const Draft& draft_;
  double latest_;
  std::vector<Known> known_;
};

/// Cheapest first: those that cost no border, and others while there are more moves than there may be.
void return_needless(Draft& draft, double latest, std::size_t most_moves) {
  using Entry = std::pair<double, Draft::Index>;
  Returns returns(draft, latest);
  for (bool any = true; std::exchange(any, false);) {
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (Draft::Index i = 0; i < draft.size(); ++i)
      if (const auto change = returns.of(i)) queue.emplace(change->border_for_a_move(), i);
    while (!queue.empty()) {
      const auto [price, i] = queue.top();
      queue.pop();
      if (price > 0 && draft.moves() <= most_moves) break;
      const auto change = returns.of(i);
      if (!change) continue;
      if (change->border_for_a_move() > price) {  // others have returned since
        queue.emplace(change->border_for_a_move(), i);
        continue;
      }
      draft.make(*change);
      any = true;
    }
  }
}

/// The change of `i` that saves most border, less the price of further moves.
OptionalChange best_place(const Draft& draft, Draft::Index i, double latest, std::size_t most_moves,
                          double price_of_move) {
  OptionalChange best;
  double most_saved = 1e-9 * price_of_move;  // not rounding errors
  for (const Rank to : draft.ranks_around(i))
    for_each_change(draft, i, to, latest, [&](const Draft::Change& change) {
      const std::size_t further = change.saved < 0 ? static_cast<std::size_t>(-change.saved) : 0;
      const double saved = -change.border - static_cast<double>(further) * price_of_move;
      if (saved <= most_saved || (further > 0 && draft.moves() + further > most_moves)) return;
      most_saved = saved;
      best = change;
    });
  return best;
}

void shorten_border(Draft& draft, double latest, std::size_t most_moves) {
  const double price_of_move = draft.mean_border();
  std::vector<bool> asked(draft.size(), false);
  const auto ask_around = [&](Draft::Index i) {
    if (i == Draft::kNone) return;
    asked[i] = false;
    for (const Draft::Border& b : draft.borders(i)) asked[b.beyond] = false;
  };
  for (bool any = true; std::exchange(any, false);)
    for (Draft::Index i = 0; i < draft.size(); ++i) {
      if (draft.load(i).fixed || asked[i]) continue;
      asked[i] = true;
      const auto change = best_place(draft, i, latest, most_moves, price_of_move);
      if (!change) continue;
      draft.make(*change);
      ask_around(change->goes);
      ask_around(change->comes);
      any = true;
    }
}

}  // namespace

std::vector<Move> mend_plan(const LoadSnapshot& snapshot, std::span<const Move> moves, const MoveCost& cost,
                            const MendingLimits& limits) {
  Draft draft(snapshot, moves, cost);
  relieve_late_ranks(draft, limits.latest);
  return_needless(draft, limits.finish, limits.moves);
  if (draft.moves() > limits.moves) return_needless(draft, limits.latest, limits.moves);
  shorten_border(draft, limits.finish, limits.moves);
  note_effort("mend", static_cast<double>(draft.considered()));
  return draft.list();
}

Efforts effort_of_mending(const LoadSnapshot& snapshot) {
  return {{"mend", 25 * static_cast<double>(snapshot.subdomains.size())}};
}

}  // namespace driftmesh::balancer
