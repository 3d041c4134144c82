#include "sim/turns.hpp"

#include <algorithm>
#include <array>
#include <csignal>
#include <exception>
#include <thread>
#include <utility>

namespace driftmesh::sim {
namespace {

constexpr double kMoment = 0.25;  // seconds after which a rank that waits looks up
constexpr double kMost = 20'000;  // seconds after which nobody will ever go on
constexpr double kSlowness = 15;

/// Whether the process handles SIGTERM, which would end it otherwise.
bool is_told_to_end_in_order() {
  struct sigaction now {};
  return ::sigaction(SIGTERM, nullptr, &now) == 0 && now.sa_handler != SIG_DFL;
}

}  // namespace

Turns::Turns(std::int32_t ranks, std::uint64_t seed, std::vector<Fault> faults)
    : random_(seed * 0x9e3779b97f4a7c15u + 5), ranks_(static_cast<std::size_t>(ranks)) {
  for (Fault& fault : faults) faults_.push_back({fault});
  ahead_ = std::array{0.02, 0.1, 0.4}[below(3)];
}

void Turns::run(const std::function<void(Rank)>& work, std::function<void()> at_end) {
  at_end_ = std::move(at_end);
  turn_ = static_cast<Rank>(below(ranks_.size()));
  std::vector<std::thread> threads;
  for (const Rank r : ids_of(ranks_))
    threads.emplace_back([this, r, &work] {
      {
        std::unique_lock lock(mutex_);
        ranks_[r].its_turn.wait(lock, [&] { return turn_ == r; });
      }
      try {
        if (!ended_) work(r);
      } catch (const Over&) {
      }
      leave(r);
    });
  for (std::thread& thread : threads) thread.join();
}

void Turns::leave(Rank r) {
  const std::unique_lock lock(mutex_);
  ranks_[r].is_gone = true;
  if (const auto other = next()) {
    turn_ = *other;
    ranks_[turn_].its_turn.notify_one();
  }
}

void Turns::spend(Rank r, double seconds) {
  std::unique_lock lock(mutex_);
  if (ended_ && std::uncaught_exceptions() > 0) return;  // in a destructor, on the way out
  if (!ended_) {
    ranks_[r].time += seconds * ranks_[r].slowness * 2 * chance();
    meet_faults(r);
    hand_on(lock, r);
  }
  if (ended_) throw Over{};
}

void Turns::wait(Rank r) {
  ranks_[r].waits_until = now() + kMoment;
  spend(r, 0);
}

void Turns::abort() {
  end();
  throw Over{};
}

void Turns::end() {
  if (ended_) return;
  ended_ = now();
  at_end_();
}

void Turns::hand_on(std::unique_lock<std::mutex>& lock, Rank from) {
  const auto other = next();
  if (!other || *other == from) return;
  turn_ = *other;
  ranks_[turn_].its_turn.notify_one();
  ranks_[from].its_turn.wait(lock, [&] { return turn_ == from; });
}

/// Who goes on; when the job has ended, who leaves next.
std::optional<Rank> Turns::next() {
  if (ended_) return any_left();
  std::optional<Rank> first;
  for (const Rank r : ids_of(ranks_))
    if (!ranks_[r].is_gone && (!first || ranks_[r].goes_on() < ranks_[*first].goes_on())) first = r;
  if (!first) return first;
  const double at = ranks_[*first].goes_on();
  const OneRank& present = ranks_[turn_];
  const bool may_go_on = !present.is_gone && present.goes_on() == present.time && present.time <= at + ahead_;
  if (std::min(at, kMost) >= std::min(ends_at_, kMost)) {
    stuck_ = at >= kMost && ends_at_ >= kMost;
    end();
    return any_left();
  }
  if (may_go_on) return turn_;
  ranks_[*first].time = at;
  return first;
}

std::optional<Rank> Turns::any_left() const {
  for (const Rank r : ids_of(ranks_))
    if (!ranks_[r].is_gone) return r;
  return std::nullopt;
}

Fault* Turns::due(Rank r, Fault::Kind kind) {
  for (Due& due : faults_) {
    if (due.is_met || due.fault.rank != r || due.fault.kind != kind || ranks_[r].time < due.fault.at) continue;
    due.is_met = true;
    met_.push_back(due.fault);
    met_.back().at = ranks_[r].time;
    return &due.fault;
  }
  return nullptr;
}

void Turns::meet_faults(Rank r) {
  using Kind = Fault::Kind;
  OneRank& rank = ranks_[r];
  const double now = rank.time;
  if (const Fault* const fault = due(r, Kind::kKill)) {
    rank.away_until = kNever;
    ends_at_ = now + fault->lasts;
  }
  if (const Fault* const fault = due(r, Kind::kHang)) {
    rank.away_until = kNever;
    ends_at_ = now + fault->lasts;
  }
  if (const Fault* const fault = due(r, Kind::kPause)) rank.away_until = now + fault->lasts;
  if (const Fault* const fault = due(r, Kind::kLate)) rank.late_until = now + fault->lasts;
  if (const Fault* const fault = due(r, Kind::kFull)) rank.full_until = now + fault->lasts;
  if (due(r, Kind::kSlow) != nullptr) rank.slowness = kSlowness;
  if (due(r, Kind::kTerminate) != nullptr && is_told_to_end_in_order()) std::raise(SIGTERM);
}

double Turns::delay(Rank r) {
  const OneRank& rank = ranks_[r];
  return rank.time < rank.late_until ? chance() * (rank.late_until - rank.time) : 0;
}

Turns::Written Turns::writes(Rank r, std::size_t bytes) {
  if (ended_) return {bytes};
  if (ranks_[r].time < ranks_[r].full_until) return {bytes, true};
  const Fault* const fault = due(r, Fault::Kind::kKillAtWrite);
  if (fault == nullptr) return {bytes};
  return {static_cast<std::size_t>(fault->part * static_cast<double>(bytes)), false, true};
}

Turns::Moment Turns::renames(Rank r) {
  if (ended_) return Moment::kNever;
  const Fault* const fault = due(r, Fault::Kind::kKillAtWrite);
  if (fault == nullptr) return Moment::kNever;
  return fault->part < 0.5 ? Moment::kBefore : Moment::kAfter;
}

}  // namespace driftmesh::sim
