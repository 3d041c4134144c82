#include "adapt/few_moves.hpp"

#include <optional>
#include <set>
#include <utility>

namespace driftmesh::adapt {
namespace {

/// What ranks have and may have, while parts move.
class Room {
 public:
  Room(const Loads& loads, IdVector<SubdomainId, Rank> holders, double even)
      : loads_(loads),
        holders_(std::move(holders)),
        speeds_(speeds_of(loads)),
        work_(speeds_.size(), 0.0),
        left_(speeds_.size(), false) {
    double all = 0, speeds = 0;
    for (const SubdomainId s : ids_of(holders_)) {
      work_[holders_[s]] += loads_.work[s];
      all += loads_.work[s];
    }
    for (const double speed : speeds_) speeds += speed;
    for (const double speed : speeds_) most_.push_back(even * all * speed / speeds);
  }

  /// Of the ranks that have too much, but those that were left alone.
  [[nodiscard]] std::optional<Rank> slowest() const {
    std::optional<Rank> slowest;
    for (const Rank r : ids_of(work_))
      if (excess(r) > 0 && !left_[r] && (!slowest || work_[r] * speeds_[*slowest] > work_[*slowest] * speeds_[r]))
        slowest = r;
    return slowest;
  }
  void leave(Rank r) { left_[r] = true; }
  [[nodiscard]] Rank emptiest() const {
    Rank emptiest{0};
    for (const Rank r : ids_of(work_))
      if (excess(r) / most_[r] < excess(emptiest) / most_[emptiest]) emptiest = r;
    return emptiest;
  }
  /// What a rank has too much; <= 0: nothing.
  [[nodiscard]] double excess(Rank r) const { return work_[r] - most_[r]; }
  [[nodiscard]] bool has_room(Rank r, SubdomainId s) const { return work_[r] + loads_.work[s] <= most_[r]; }
  [[nodiscard]] const IdVector<SubdomainId, Rank>& holders() const { return holders_; }
  [[nodiscard]] double work(SubdomainId s) const { return loads_.work[s]; }

  void move(SubdomainId s, Rank to) {
    work_[holders_[s]] -= loads_.work[s];
    work_[to] += loads_.work[s];
    holders_[s] = to;
  }

 private:
  const Loads& loads_;
  IdVector<SubdomainId, Rank> holders_;
  IdVector<Rank, double> speeds_;
  IdVector<Rank, double> work_;
  IdVector<Rank, double> most_;
  IdVector<Rank, bool> left_;
};

std::set<Rank> ranks_beside(const Room& room, Rank rank,
                            const std::vector<std::pair<SubdomainId, SubdomainId>>& neighbors) {
  std::set<Rank> ranks;
  for (const auto& [a, b] : neighbors) {
    if (room.holders()[a] == rank) ranks.insert(room.holders()[b]);
    if (room.holders()[b] == rank) ranks.insert(room.holders()[a]);
  }
  return ranks;
}

struct Move {
  SubdomainId part = kNoSubdomain;
  Rank to{};
};

/// The lower, the better a part suits: best is what suffices and is not much more, the smallest first; then what does
/// not suffice, the largest first; then what is much more.
std::pair<int, double> suits(double work, double excess) {
  constexpr double kNotMuchMore = 1.5;
  if (work < excess) return {1, -work};
  return {work <= kNotMuchMore * excess ? 0 : 2, work};
}

/// The best move of one part to the rank of a neighbor; or else of any part to a rank beside, or to the emptiest one.
Move best_move(const Room& room, Rank from, const std::vector<std::pair<SubdomainId, SubdomainId>>& neighbors) {
  Move best;
  const double excess = room.excess(from);
  const auto consider = [&](SubdomainId part, Rank to) {
    if (room.holders()[part] != from || to == from || !(room.work(part) > 0) || !room.has_room(to, part)) return;
    if (best.part == kNoSubdomain || suits(room.work(part), excess) < suits(room.work(best.part), excess))
      best = {part, to};
  };
  for (const auto& [a, b] : neighbors) {
    consider(a, room.holders()[b]);
    consider(b, room.holders()[a]);
  }
  if (best.part != kNoSubdomain) return best;
  for (const Rank to : ranks_beside(room, from, neighbors))
    for (const SubdomainId part : ids_of(room.holders())) consider(part, to);
  if (best.part != kNoSubdomain) return best;
  const Rank emptiest = room.emptiest();
  for (const SubdomainId part : ids_of(room.holders())) consider(part, emptiest);
  return best;
}

}  // namespace

IdVector<SubdomainId, Rank> few_moves(const Loads& loads, const IdVector<SubdomainId, Rank>& holders,
                                      const std::vector<std::pair<SubdomainId, SubdomainId>>& neighbors, double even) {
  Room room(loads, holders, even);
  for (std::optional<Rank> slowest; (slowest = room.slowest());) {
    const Move move = best_move(room, *slowest, neighbors);
    if (move.part == kNoSubdomain)
      room.leave(*slowest);
    else
      room.move(move.part, move.to);
  }
  return room.holders();
}

IdVector<SubdomainId, Rank> even_holders(const Loads& loads, const IdVector<SubdomainId, Rank>& holders,
                                         const Decomposition& decomposition,
                                         const std::function<IdVector<SubdomainId, Rank>()>& anew) {
  if (imbalance(loads, holders) <= kEven) return holders;
  std::vector<std::pair<SubdomainId, SubdomainId>> neighbors;
  for (const Interface& i : interfaces(decomposition)) neighbors.emplace_back(i.first, i.second);
  const IdVector<SubdomainId, Rank> few = few_moves(loads, holders, neighbors, kEven);
  return imbalance(loads, few) <= kEven ? few : few_moves(loads, anew(), neighbors, kEven);
}

}  // namespace driftmesh::adapt
