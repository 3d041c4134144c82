#pragma once

#include <memory>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include "protocol/rank_step.hpp"
#include "protocol/transport.hpp"

namespace driftmesh::protocol {

/// A message in transit.
struct Parcel {
  Rank source;
  Bytes bytes;
  std::uint64_t serial;  ///< counts the sends of all ranks
  bool is_copy;
  std::uint64_t sent;  ///< the step in which it was
};

enum class Urgency {
  kAnyTime,  ///< may be delivered at random
  kFirst,    ///< before all others
  kNotYet,   ///< must wait; every message must be released eventually
};

/// How an adversarial network treats its ranks. The seed decides everything else.
struct Adversary {
  std::uint64_t seed = 1;
  bool fifo = false;      ///< keep the order between each two ranks, as MPI does
  double delay = 0.3;     ///< chance that a poll finds nothing although a message could be delivered
  bool starve = false;    ///< one rank is not stepped for a long time
  bool hold_one = false;  ///< one of the first messages is held back for a long time
  double copy = 0;        ///< chance that a message that may_copy is delivered a second time, at any later moment
  std::function<bool(Rank source, std::span<const std::byte>)> may_copy;  ///< none, if empty
  /// If set, called for each parcel when its receiver polls, with the number of the step.
  std::function<Urgency(const Parcel&, std::uint64_t step)> urgency = {};
  std::uint64_t step_limit = 50'000'000;

  /// All members except the functions, drawn from the seed.
  static Adversary from_seed(std::uint64_t seed);
};

/// Ranks on one thread of one process, with a network that does its worst within the contract of Transport. The seed
/// makes a run exactly reproducible.
class AdversarialNetwork {
 public:
  AdversarialNetwork(std::int32_t ranks, Adversary adversary);
  ~AdversarialNetwork();
  AdversarialNetwork(const AdversarialNetwork&) = delete;
  AdversarialNetwork& operator=(const AdversarialNetwork&) = delete;

  [[nodiscard]] Transport& transport(Rank rank);

  /// Steps the ranks, steps[r] for rank r, in an order drawn from the seed until all have finished or none can go on.
  /// `after_step` is called after each step with the rank that took it. An exception thrown by a step ends the run.
  RunResult run(IdSpan<Rank, const RankStep> steps, const std::function<void(Rank)>& after_step = {});

  /// Messages in transit to a rank, including copies.
  [[nodiscard]] const std::vector<Parcel>& under_way(Rank destination) const;
  /// Messages sent and not delivered, without copies.
  [[nodiscard]] std::uint64_t in_flight() const { return in_flight_; }

  /// What the adversary really did, so that tests can check that it did something.
  struct Counters {
    std::uint64_t delivered = 0;
    std::uint64_t reordered = 0;  ///< delivered before an older message between the same two ranks
    std::uint64_t copies = 0;     ///< delivered a second time
    std::uint64_t starved = 0;    ///< steps that a rank was not given
    std::uint64_t held = 0;       ///< deliveries that went ahead of the message held back
  };
  [[nodiscard]] const Counters& counters() const { return counters_; }

 private:
  class Endpoint;

  std::uint64_t below(std::uint64_t n) { return random_() % n; }
  bool chance(double probability) { return static_cast<double>(random_() >> 11) * 0x1p-53 < probability; }
  void send(Rank source, Rank destination, Bytes bytes);
  std::optional<Received> poll(Rank destination);
  [[nodiscard]] bool is_held(const Parcel& parcel) const;
  [[nodiscard]] Urgency urgency(const Parcel& parcel) const;
  [[nodiscard]] std::vector<std::size_t> deliverable(const std::vector<Parcel>& box) const;
  Received deliver(std::vector<Parcel>& box, std::size_t which);
  [[nodiscard]] bool is_starved(Rank rank) const;

  Adversary adversary_;
  std::mt19937_64 random_;
  IdVector<Rank, std::unique_ptr<Endpoint>> endpoints_;
  IdVector<Rank, std::vector<Parcel>> boxes_;  // by destination
  std::uint64_t steps_ = 0;
  std::uint64_t serial_ = 0;
  std::uint64_t in_flight_ = 0;
  std::uint64_t activity_ = 0;  // sends and deliveries so far

  std::optional<Rank> starved_;
  std::uint64_t starve_from_ = 0, starve_to_ = 0;  // steps
  std::uint64_t held_serial_ = UINT64_MAX;
  std::uint64_t release_ = 0;  // the step at which the held message is released
  Counters counters_;
};

}  // namespace driftmesh::protocol
