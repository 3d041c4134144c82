#pragma once

#include "protocol/rank_protocol.hpp"

/// Rules of the protocol with one mistake each, for tests that have to notice: with toy ranks, and with real meshes.
namespace driftmesh::testing {

/// A rank counts as passive, and SPLITs as sent when they leave, while the aggregator holds some.
struct PassiveWithSplitsToSend : protocol::SoundRules {
  static constexpr bool counts_as_sent(Station station) {
    return station == Station::kLeavesAggregator || station == Station::kGivenAway;
  }
  static constexpr bool flushes_when_idle() { return false; }
  static constexpr bool passive(bool program_is_passive, bool, bool nothing_held) {
    return program_is_passive && nothing_held;
  }
};

/// An idle rank keeps what its aggregator has collected.
struct NoFlushWhenIdle : protocol::SoundRules {
  static constexpr bool flushes_when_idle() { return false; }
};

struct ForwardingCountsAsSending : protocol::SoundRules {
  static constexpr bool counts_as_sent(Station station) {
    return station == Station::kForwarded || SoundRules::counts_as_sent(station);
  }
};

/// What is held back counts as handled, and again when it is.
struct HoldingCountsAsHandling : protocol::SoundRules {
  static constexpr bool counts_as_handled(Station station) {
    return station == Station::kHeld || SoundRules::counts_as_handled(station);
  }
};

struct HandOffsAreNotCounted : protocol::SoundRules {
  static constexpr bool counts_as_sent(Station station) { return station == Station::kEntersAggregator; }
  static constexpr bool counts_as_handled(Station station) { return station == Station::kReachesSubdomain; }
};

/// The location heard of last is believed, however old it is.
struct NoEpochs : protocol::SoundRules {
  static constexpr bool supersedes(const protocol::Location&, const protocol::Location&) { return true; }
};

}  // namespace driftmesh::testing
