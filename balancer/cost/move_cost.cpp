#include "balancer/cost/move_cost.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <tuple>

#include "balancer/snapshot/effort.hpp"
#include "protocol/packed_size.hpp"

namespace driftmesh::balancer {
namespace {

/// A move, and its effect on the finishing times of both ranks.
struct Candidate {
  Move move;
  Rank from{};
  double giver_saves = 0;  // seconds
  double taker_spends = 0;
  double price = 0;  // cost over work, in seconds per second
  bool kept = true;
};

class Selection {
 public:
  Selection(const LoadSnapshot& snapshot, const MoveCost& cost)
      : snapshot_(snapshot), cost_(cost), speeds_(assumed_speeds(snapshot.ranks)) {
    for (const Rank r : ids_of(speeds_)) {
      times_.push_back(snapshot.ranks[r].remaining / speeds_[r]);
      free_memory_.push_back(snapshot.ranks[r].free_memory);
    }
  }

  void consider(std::span<const Move> moves) {
    for (const Move& move : moves) static_cast<void>(consider(move));
  }

  Verdict consider(const Move& move) {
    const SubdomainLoad* const s = find(snapshot_, move.subdomain);
    if (!s || !speeds_.has(move.destination) || move.destination == s->owner) return Verdict::kInvalid;
    if (s->fixed) return Verdict::kFixed;
    if (taken_twice(move.subdomain)) return Verdict::kInvalid;
    const double giver_speed = speeds_[s->owner], taker_speed = speeds_[move.destination];
    const double giving = cost_.for_giver(s->bytes, giver_speed), taking = cost_.for_taker(s->bytes, taker_speed);
    const double saved = s->remaining / giver_speed - giving;
    const double received = s->remaining / taker_speed + taking;
    if (saved <= 0) return Verdict::kCostsMore;
    if (memory_for(*s) > free_memory_[move.destination]) return Verdict::kNoMemory;
    candidates_.push_back({move, s->owner, saved, received, (giving + taking) / s->remaining, true});
    times_[s->owner] -= saved;
    times_[move.destination] += received;
    free_memory_[move.destination] -= memory_for(*s);
    return Verdict::kDone;
  }

  [[nodiscard]] double finish() const { return times_.empty() ? 0 : *std::max_element(times_.begin(), times_.end()); }

  [[nodiscard]] const IdVector<Rank, double>& times() const { return times_; }

  /// Drops moves that are not needed to finish by `time`.
  void drop_needless(double time) {
    std::vector<Candidate*> dearest_first;
    for (Candidate& c : candidates_) dearest_first.push_back(&c);
    std::sort(dearest_first.begin(), dearest_first.end(), [](const Candidate* a, const Candidate* b) {
      return std::tuple(-a->price, a->move.subdomain) < std::tuple(-b->price, b->move.subdomain);
    });
    for (Candidate* c : dearest_first) {
      if (times_[c->from] + c->giver_saves > time) continue;
      times_[c->from] += c->giver_saves;
      times_[c->move.destination] -= c->taker_spends;
      c->kept = false;
    }
  }

  [[nodiscard]] std::vector<Move> kept() const {
    std::vector<Move> moves;
    for (const Candidate& c : candidates_)
      if (c.kept) moves.push_back(c.move);
    return moves;
  }

  [[nodiscard]] std::vector<JudgedMove> judged() const {
    std::vector<JudgedMove> moves;
    for (const Candidate& c : candidates_)
      moves.push_back({c.move.subdomain, c.from, c.move.destination, c.kept ? Verdict::kDone : Verdict::kNeedless});
    return moves;
  }

 private:
  bool taken_twice(SubdomainId id) {
    const auto place = std::lower_bound(taken_.begin(), taken_.end(), id);
    if (place != taken_.end() && *place == id) return true;
    taken_.insert(place, id);
    return false;
  }

  const LoadSnapshot& snapshot_;
  const MoveCost& cost_;
  IdVector<Rank, double> speeds_;
  IdVector<Rank, double> times_;        // finishing times with the remaining moves
  IdVector<Rank, double> free_memory_;  // what leaves may do so after something else has come
  std::vector<Candidate> candidates_;
  std::vector<SubdomainId> taken_;  // ascending
};

/// Considers only subdomains that fit in one message; returns the moves that are out of the question, and why.
std::vector<JudgedMove> consider_those_that_fit(Selection& selection, const LoadSnapshot& snapshot,
                                                std::span<const Move> moves) {
  std::vector<JudgedMove> out;
  for (const Move& move : moves) {
    const SubdomainLoad* const s = find(snapshot, move.subdomain);
    const bool fits = s == nullptr || s->bytes <= protocol::kMostPackedBytes;
    const Verdict verdict = fits ? selection.consider(move) : Verdict::kTooLarge;
    if (verdict != Verdict::kDone)
      out.push_back({move.subdomain, s == nullptr ? move.destination : s->owner, move.destination, verdict});
  }
  return out;
}

}  // namespace

void price_moves(LoadSnapshot& snapshot, const MoveCost& cost) {
  const IdVector<Rank, double> speeds = assumed_speeds(snapshot.ranks);
  const double mean = std::accumulate(speeds.begin(), speeds.end(), 0.0) / static_cast<double>(speeds.size());
  for (SubdomainLoad& s : snapshot.subdomains) {
    s.cost = cost.for_giver(s.bytes, mean) + cost.for_taker(s.bytes, mean);
    s.fixed = s.cost * mean > s.remaining;
  }
}

double noise_of(const LoadSnapshot& snapshot) {
  const IdVector<Rank, double> speeds = assumed_speeds(snapshot.ranks);
  double squares = 0, working = 0;
  for (const Rank r : ids_of(speeds)) {
    if (snapshot.ranks[r].remaining <= 0) continue;
    const double deviation = snapshot.ranks[r].doubt * snapshot.ranks[r].remaining / speeds[r];
    squares += deviation * deviation;
    ++working;
  }
  // The largest of 2, 4, 16 and 144 normal deviates is 0.56, 1.03, 1.77 and 2.6 on average.
  return working < 2 ? 0 : (std::sqrt(2 * std::log(working)) - 0.6) * std::sqrt(squares / working);
}

void be_sure_of_idle_ranks(LoadSnapshot& snapshot) {
  const auto idle = [](const RankLoad& rank) { return rank.remaining <= 0 && rank.free_memory > 0; };
  if (std::ranges::none_of(snapshot.ranks, idle)) return;
  for (RankLoad& rank : snapshot.ranks) rank.doubt = 0;
}

double gain_beyond(double noise, double apparent) {
  return apparent > noise ? std::max(0.0, std::sqrt(apparent * apparent - noise * noise) - noise) : 0;
}

double possible_gain(const LoadSnapshot& snapshot) {
  return gain_beyond(noise_of(snapshot), finishing_time(snapshot) - ideal_time(snapshot));
}

std::vector<Move> worth_moving(const LoadSnapshot& snapshot, std::span<const Move> moves, const MoveCost& cost,
                               const Worth& worth, Kept kept) {
  note_effort("weigh", static_cast<double>(moves.size()));
  Selection selection(snapshot, cost);
  const double before = selection.finish();
  const std::vector<JudgedMove> out = consider_those_that_fit(selection, snapshot, moves);
  if (kept == Kept::kNeeded)
    selection.drop_needless(std::max(selection.finish(), ideal_time(snapshot) * (1 + worth.slack)));
  const double saved = gain_beyond(noise_of(snapshot), before - selection.finish());
  const Verdict verdict = moves.empty()                                                        ? Verdict::kNoMoves
                          : saved <= 0 || saved < worth.gain * before || saved < worth.seconds ? Verdict::kSmallSaving
                                                                                               : Verdict::kDone;
  if (is_logged()) {
    Deliberation plan{.subject = Deliberation::Subject::kPlan,
                      .verdict = verdict,
                      .saves = saved,
                      .whole = kept == Kept::kAll,
                      .moves = out};
    for (const JudgedMove& move : selection.judged()) plan.moves.push_back(move);
    note(std::move(plan));
  }
  return verdict == Verdict::kDone ? selection.kept() : std::vector<Move>{};
}

IdVector<Rank, double> finishing_times(const LoadSnapshot& snapshot, std::span<const Move> moves,
                                       const MoveCost& cost) {
  Selection selection(snapshot, cost);
  selection.consider(moves);
  return selection.times();
}

}  // namespace driftmesh::balancer
