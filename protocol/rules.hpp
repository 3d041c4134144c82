#pragma once

#include "protocol/directory.hpp"

namespace driftmesh::protocol {

/// The decisions that the proofs in docs/protocol.md rest on, in one place so that tests can replace each by a wrong
/// one and see that it is noticed.
class Rules {
 public:
  /// The stations of a SPLIT on its way to the subdomain that it is for, and of a subdomain on its way to a rank.
  enum class Station {
    kEntersAggregator,
    kLeavesAggregator,
    kForwarded,
    kHeld,
    kReleased,  ///< was held, and its subdomain has come
    kReachesSubdomain,
    kGivenAway,
    kArrives
  };

  Rules() = default;
  virtual ~Rules() = default;
  Rules(const Rules&) = delete;
  Rules& operator=(const Rules&) = delete;

  /// Each counts as sent once, and from the first moment: nothing that waits anywhere is unknown to the counts.
  [[nodiscard]] virtual bool counts_as_sent(Station station) const {
    return station == Station::kEntersAggregator || station == Station::kGivenAway;
  }
  /// Each counts as handled once, and not before it is where it belongs: what is held back is still under way.
  [[nodiscard]] virtual bool counts_as_handled(Station station) const {
    return station == Station::kReachesSubdomain || station == Station::kReleased || station == Station::kArrives;
  }
  /// A rank with nothing to do does not let others wait for what it has collected.
  [[nodiscard]] virtual bool flushes_when_idle() const { return true; }
  /// A rank passes the token only when nothing that it holds could become work.
  [[nodiscard]] virtual bool passive(bool program_is_passive, bool aggregator_empty, bool nothing_held) const {
    return program_is_passive && aggregator_empty && nothing_held;
  }
  /// A rank calls itself passive only when none of its subdomains has work.
  [[nodiscard]] virtual bool rests(bool has_work) const { return !has_work; }
  /// Records only move forward.
  [[nodiscard]] virtual bool supersedes(const Location& news, const Location& record) const {
    return news.epoch > record.epoch;
  }
};

/// The rules as they must be.
[[nodiscard]] inline const Rules& sound_rules() {
  static const Rules rules;
  return rules;
}

}  // namespace driftmesh::protocol
