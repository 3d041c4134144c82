#pragma once

#include "protocol/rules.hpp"

/// Rules of the protocol with one mistake each, which tests must notice: with toy ranks, and with real meshes.
namespace driftmesh::testing {

/// A rank counts as passive, and SPLITs as sent when they leave, while the aggregator holds some.
struct PassiveWithSplitsToSend final : protocol::Rules {
  [[nodiscard]] bool counts_as_sent(Station station) const override {
    return station == Station::kLeavesAggregator || station == Station::kGivenAway;
  }
  [[nodiscard]] bool flushes_when_idle() const override { return false; }
  [[nodiscard]] bool passive(bool program_is_passive, bool, bool nothing_held) const override {
    return program_is_passive && nothing_held;
  }
};

/// An idle rank does not flush its aggregator.
struct NoFlushWhenIdle final : protocol::Rules {
  [[nodiscard]] bool flushes_when_idle() const override { return false; }
};

struct ForwardingCountsAsSending final : protocol::Rules {
  [[nodiscard]] bool counts_as_sent(Station station) const override {
    return station == Station::kForwarded || Rules::counts_as_sent(station);
  }
};

/// Held messages count as handled, and again when they are.
struct HoldingCountsAsHandling final : protocol::Rules {
  [[nodiscard]] bool counts_as_handled(Station station) const override {
    return station == Station::kHeld || Rules::counts_as_handled(station);
  }
};

struct HandOffsAreNotCounted final : protocol::Rules {
  [[nodiscard]] bool counts_as_sent(Station station) const override { return station == Station::kEntersAggregator; }
  [[nodiscard]] bool counts_as_handled(Station station) const override { return station == Station::kReachesSubdomain; }
};

/// The location received last is believed, however old it is.
struct NoEpochs final : protocol::Rules {
  [[nodiscard]] bool supersedes(const protocol::Location&, const protocol::Location&) const override { return true; }
};

}  // namespace driftmesh::testing
