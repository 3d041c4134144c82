#pragma once

#include <optional>
#include <random>
#include <vector>

#include "protocol/transport_layer.hpp"
#include "sim/witness.hpp"

namespace driftmesh::sim {

/// The location updates that any rank of a run was told.
struct Rumours {
  std::mt19937_64 random;
  std::vector<Bytes> heard;
};

/// What comes to a rank, with half of the location updates replaced by other ones of the run: true of the past, out of
/// date, perhaps told before. Their number stays, since the fence counts them.
class RumourTransport final : public protocol::TransportLayer {
 public:
  RumourTransport(protocol::Transport& inner, Rumours& rumours) : TransportLayer(inner), rumours_(rumours) {}

  std::optional<protocol::Received> poll() override {
    auto received = TransportLayer::poll();
    if (!received || !is<protocol::LocationUpdate>(received->bytes)) return received;
    rumours_.heard.push_back(received->bytes);
    if (rumours_.random() % 2 == 0) received->bytes = rumours_.heard[rumours_.random() % rumours_.heard.size()];
    return received;
  }

 private:
  Rumours& rumours_;
};

}  // namespace driftmesh::sim
