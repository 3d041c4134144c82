#pragma once

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <mutex>
#include <optional>
#include <random>
#include <vector>

#include "driftmesh/id_vector.hpp"
#include "driftmesh/ids.hpp"

namespace driftmesh::sim {

/// What befalls a rank, at the first thing that it does from a moment of virtual time on.
struct Fault {
  enum class Kind : std::uint8_t {
    kKill,         ///< it does nothing anymore; a little later the others are ended, too
    kKillAtWrite,  ///< the whole job ends while this rank writes, when a part of the bytes is on the disk
    kHang,         ///< it does nothing anymore, and nobody ends the others
    kTerminate,    ///< all are told to end (SIGTERM)
    kPause,        ///< it does nothing for some time
    kSlow,         ///< from now on all that it does takes longer
    kLate,         ///< for some time, what it sends takes long
    kFull,         ///< for some time, the disk takes no more bytes from it
  };
  Kind kind = Kind::kKill;
  Rank rank{};
  double at = 0;     ///< seconds
  double lasts = 0;  ///< seconds
  double part = 0;   ///< in [0, 1): of a write, see kKillAtWrite
};

/// Ranks as threads of this process of which one runs at a time: the one that is behind the others in virtual time, by
/// which each says how long it takes what it does. How long it really takes, and how far one may be ahead, is drawn
/// from the seed, so that a run is exactly reproducible.
class Turns {
 public:
  /// Thrown by what a rank does when its job has ended.
  struct Over {};

  Turns(std::int32_t ranks, std::uint64_t seed, std::vector<Fault> faults);

  /// Lets all ranks work, until each has returned or thrown Over. `at_end`: called once when the job ends before that.
  void run(const std::function<void(Rank)>& work, std::function<void()> at_end);

  // For the rank whose turn it is:

  /// It has done something that takes this long.
  void spend(Rank r, double seconds);
  /// It has nothing to do until wake(), but looks up now and then.
  void wait(Rank r);
  void wake(Rank r) { ranks_[r].waits_until = std::min(ranks_[r].waits_until, now()); }
  /// The job ends now, for all.
  [[noreturn]] void abort();

  /// It writes so many bytes: how many of these get to the disk, and what then.
  struct Written {
    std::size_t bytes = 0;
    bool is_refused = false;
    bool is_last = false;  ///< end() is to be called
  };
  [[nodiscard]] Written writes(Rank r, std::size_t bytes);
  /// It renames a file: whether the job ends before, or after.
  enum class Moment : std::uint8_t { kNever, kBefore, kAfter };
  [[nodiscard]] Moment renames(Rank r);
  void end();

  /// The time of the rank whose turn it is.
  [[nodiscard]] double now() const { return ranks_[turn_].time; }
  /// How long a message takes that it sends now.
  [[nodiscard]] double delay(Rank r);
  /// For what else is left to chance.
  [[nodiscard]] std::uint64_t below(std::uint64_t n) { return random_() % n; }

  // After run():

  /// When the job ended before all had done their work.
  [[nodiscard]] const std::optional<double>& ended() const { return ended_; }
  /// Nobody would ever have gone on.
  [[nodiscard]] bool stuck() const { return stuck_; }
  /// Faults that have come.
  [[nodiscard]] const std::vector<Fault>& met() const { return met_; }

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  struct OneRank {
    std::condition_variable its_turn;
    double time = 0;
    double waits_until = 0, away_until = 0;
    [[nodiscard]] double goes_on() const { return std::max({time, waits_until, away_until}); }
    double late_until = -kNever, full_until = -kNever;
    double slowness = 1;
    bool is_gone = false;
  };
  struct Due {
    Fault fault;
    bool is_met = false;
  };

  [[nodiscard]] double chance() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  [[nodiscard]] Fault* due(Rank r, Fault::Kind kind);
  void meet_faults(Rank r);
  [[nodiscard]] std::optional<Rank> next();
  [[nodiscard]] std::optional<Rank> any_left() const;
  void hand_on(std::unique_lock<std::mutex>& lock, Rank from);
  void leave(Rank r);

  std::mutex mutex_;  // who holds it is the one whose turn it is
  std::mt19937_64 random_;
  IdVector<Rank, OneRank> ranks_;
  std::vector<Due> faults_;
  std::vector<Fault> met_;
  std::function<void()> at_end_;
  Rank turn_{0};
  double ahead_;  // seconds that a rank may be ahead of others
  double ends_at_ = kNever;
  std::optional<double> ended_;
  bool stuck_ = false;
};

}  // namespace driftmesh::sim
