#pragma once

#include <optional>
#include <random>
#include <vector>

#include "protocol/transport_layer.hpp"
#include "sim/witness.hpp"

namespace driftmesh::sim {

/// The location updates that any rank of a run has received.
struct StaleLocations {
  std::mt19937_64 random;
  std::vector<Bytes> received;
};

/// Delivers a rank's messages, with half of the location updates replaced by earlier ones of the run: valid in the
/// past, outdated, perhaps repeated. Their number does not change, since termination counts them.
class StaleLocationTransport final : public protocol::TransportLayer {
 public:
  StaleLocationTransport(protocol::Transport& inner, StaleLocations& locations)
      : TransportLayer(inner), stale_locations_(locations) {}

  std::optional<protocol::Received> poll() override {
    auto received = TransportLayer::poll();
    if (!received || !is<protocol::LocationUpdate>(received->bytes)) return received;
    stale_locations_.received.push_back(received->bytes);
    if (stale_locations_.random() % 2 == 0)
      received->bytes = stale_locations_.received[stale_locations_.random() % stale_locations_.received.size()];
    return received;
  }

 private:
  StaleLocations& stale_locations_;
};

}  // namespace driftmesh::sim
