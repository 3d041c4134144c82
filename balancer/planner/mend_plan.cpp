#include "balancer/planner/mend_plan.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <queue>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "balancer/planner/draft.hpp"

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
  const auto consider = [&](const Draft::Change& alone, Draft::Index j) {
    const auto [here, there] = draft.times_after(alone.goes, alone.to, j);
    const double gain = late(now) + late(draft.times()[alone.to]) - late(here) - late(there);
    if (gain < kLeast * late(now) || std::max(here, there) >= now || !draft.has_memory(alone.goes, alone.to, j)) return;
    const Draft::Change change = draft.in_exchange(alone, j);
    const double price = change.border / gain;
    if (price >= best_price) return;
    best_price = price;
    best = change;
  };
  for (const Rank to : helpers)
    for (const Draft::Index i : draft.held_by(rank)) {
      const Draft::Change alone = draft.change(i, to);
      consider(alone, Draft::kNone);
      for (const Draft::Index j : draft.held_by(to)) consider(alone, j);
    }
  return best;
}

/// The last first. One that nobody can help may be helped once others are no longer late.
void relieve_late_ranks(Draft& draft, double latest) {
  constexpr std::size_t kTries = 4;  // tries per rank, on average
  RanksInOrder ranks;
  for (const Rank r : ids_of(draft.times())) ranks.emplace(draft.times()[r], r);
  note_effort("search", static_cast<double>(ranks.size()));
  auto late = ranks.rbegin();
  for (std::size_t left = kTries * ranks.size(); left > 0 && late != ranks.rend() && late->first > latest; --left) {
    const Rank rank = late->second;
    const auto change = relief(draft, rank, latest, helpers_of(draft, rank, ranks));
    if (!change) {
      ++late;
      continue;
    }
    const auto changing = {rank, change->to};
    for (const Rank r : changing) ranks.erase({draft.times()[r], r});
    draft.make(*change);
    for (const Rank r : changing) ranks.emplace(draft.times()[r], r);
    late = ranks.rbegin();
  }
}

/// Whether both ranks finish by `latest`, or no later than without the change, and have memory for it.
bool is_possible(const Draft& draft, Draft::Index i, Rank to, Draft::Index j, double latest) {
  const auto [here, there] = draft.times_after(i, to, j);
  return here <= std::max(draft.times()[draft.owner(i)], latest) && there <= std::max(draft.times()[to], latest) &&
         draft.has_memory(i, to, j);
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
    known = {draft_.changes(), cheapest(i, draft_.home(i))};
    return known.cheapest;
  }

 private:
  struct Known {
    std::uint64_t when = 0;
    OptionalChange cheapest;
  };

  /// Alone or in exchange for one that has come there.
  [[nodiscard]] OptionalChange cheapest(Draft::Index i, Rank home) const {
    OptionalChange best;
    const Draft::Change alone = draft_.change(i, home);
    const auto consider = [&](Draft::Index j) {
      if (!is_possible(draft_, i, home, j, latest_)) return;
      const Draft::Change change = draft_.in_exchange(alone, j);
      if (!best || change.border_for_a_move() < best->border_for_a_move()) best = change;
    };
    consider(Draft::kNone);
    for (const Draft::Index j : draft_.held_by(home))
      if (draft_.has_moved(j)) consider(j);
    return best;
  }

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

/// A subdomain goes to a rank beside it, alone or in exchange for any one from there, if that is possible.
OptionalChange random_change(const Draft& draft, double latest, std::mt19937& random) {
  const auto pick = [&](std::size_t n) { return static_cast<std::size_t>(std::uint64_t{random()} * n >> 32); };
  const auto i = static_cast<Draft::Index>(pick(draft.size()));
  if (draft.load(i).fixed || draft.borders(i).empty()) return std::nullopt;
  const Rank to = draft.owner(draft.borders(i)[pick(draft.borders(i).size())].beyond);
  if (to == draft.owner(i)) return std::nullopt;
  const auto& held = draft.held_by(to);
  const bool alone = pick(2) == 0 || held.empty();
  const Draft::Index j = alone ? Draft::kNone : held[pick(held.size())];
  if (!is_possible(draft, i, to, j, latest)) return std::nullopt;
  return draft.in_exchange(draft.change(i, to), j);
}

/// Simulated annealing (Kirkpatrick, Gelatt and Vecchi 1983): random changes are made where they save border, and
/// others with a chance that is the less the more border they cost and the longer it has gone on. So borders become
/// shorter than where each change must save some: often it takes two or three. Returns how much longer they are, since
/// on few subdomains it can fail.
double shorten_border(Draft& draft, double latest, std::size_t most_moves) {
  constexpr int kChanges = 200;         // considered for each subdomain; twice as many leave 3 % less border
  constexpr double kPriceOfMove = 0.5;  // mean borders
  const double mean = draft.mean_border();
  std::mt19937 random;  // the same plan each time
  const std::size_t steps = kChanges * static_cast<std::size_t>(draft.size());
  note_effort("mend", static_cast<double>(steps));  // besides those that are considered further
  double longer = 0;
  for (std::size_t left = steps; left > 0; --left) {
    const auto change = random_change(draft, latest, random);
    if (!change) continue;
    if (change->saved < 0 && draft.moves() + static_cast<std::size_t>(-change->saved) > most_moves) continue;
    const double warmth = mean * static_cast<double>(left) / static_cast<double>(steps);
    const double price = change->border - kPriceOfMove * mean * change->saved;
    if (price > 0 && std::generate_canonical<double, 32>(random) >= std::exp(-price / warmth)) continue;
    draft.make(*change);
    longer += change->border;
  }
  return longer;
}

}  // namespace

std::vector<Move> mend_plan(const LoadSnapshot& snapshot, std::span<const Move> moves, const MoveCost& cost,
                            const MendingLimits& limits) {
  Draft draft(snapshot, moves, cost);
  relieve_late_ranks(draft, limits.latest);
  return_needless(draft, limits.finish, limits.moves);
  if (draft.moves() > limits.moves) return_needless(draft, limits.latest, limits.moves);
  std::vector<Move> mended = draft.list();
  if (shorten_border(draft, limits.finish, limits.moves) < 0) mended = draft.list();
  note_effort("mend", static_cast<double>(draft.considered()));
  return mended;
}

Efforts effort_of_mending(const LoadSnapshot& snapshot) {
  return {{"mend", 280 * static_cast<double>(snapshot.subdomains.size())}};
}

}  // namespace driftmesh::balancer
