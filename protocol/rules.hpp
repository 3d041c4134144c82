#pragma once

#include "protocol/directory.hpp"
#include "protocol/wave.hpp"

namespace driftmesh::protocol {

/// The decisions that the proofs in docs/protocol.md rely on, in one place, so that tests can replace each by a wrong
/// one and check that it is detected.
class Rules {
 public:
  /// The stations of a SPLIT on its way to its subdomain, and of a subdomain on its way to a rank.
  enum class Station {
    kEntersAggregator,
    kLeavesAggregator,
    kForwarded,
    kHeld,
    kReleased,  ///< was held, and its subdomain has arrived
    kReachesSubdomain,
    kGivenAway,
    kArrives
  };

  Rules() = default;
  virtual ~Rules() = default;
  Rules(const Rules&) = delete;
  Rules& operator=(const Rules&) = delete;

  /// Each counts as sent once, from the first moment: nothing that waits anywhere is missing from the counts.
  [[nodiscard]] virtual bool counts_as_sent(Station station) const {
    return station == Station::kEntersAggregator || station == Station::kGivenAway;
  }
  /// Each counts as handled once, and not before it reaches its destination: what is held back is still in transit.
  [[nodiscard]] virtual bool counts_as_handled(Station station) const {
    return station == Station::kReachesSubdomain || station == Station::kReleased || station == Station::kArrives;
  }
  /// An idle rank does not keep others waiting for SPLITs that it has aggregated.
  [[nodiscard]] virtual bool flushes_when_idle() const { return true; }
  /// A rank answers a probe only when nothing that it holds could become work.
  [[nodiscard]] virtual bool passive(bool program_is_passive, bool aggregator_empty, bool nothing_held) const {
    return program_is_passive && aggregator_empty && nothing_held;
  }
  /// A rank calls itself passive only when none of its subdomains has work.
  [[nodiscard]] virtual bool rests(bool has_work) const { return !has_work; }
  /// How many ranks may be below a rank in the tree of termination; any number from 1 to TreePlace::kMostChildren does.
  [[nodiscard]] virtual std::int32_t arity() const { return TreePlace::kMostChildren; }
  /// Records only move forward.
  [[nodiscard]] virtual bool supersedes(const Location& news, const Location& record) const {
    return news.epoch > record.epoch;
  }
};

/// The correct rules.
[[nodiscard]] inline const Rules& sound_rules() {
  static const Rules rules;
  return rules;
}

}  // namespace driftmesh::protocol
