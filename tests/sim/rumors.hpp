#pragma once

#include <optional>
#include <random>
#include <vector>

#include "protocol/transport_layer.hpp"
#include "sim/witness.hpp"

namespace driftmesh::sim {

/// The location updates that any rank of a run was told.
struct Rumors {
  std::mt19937_64 random;
  std::vector<Bytes> heard;
};

/// What comes to a rank, with half of the location updates replaced by other ones of the run: true of the past, out of
/// date, perhaps told before. Their number stays, since the fence counts them.
class RumorTransport final : public protocol::TransportLayer {
 public:
  RumorTransport(protocol::Transport& inner, Rumors& rumors) : TransportLayer(inner), rumors_(rumors) {}

  std::optional<protocol::Received> poll() override {
    auto received = TransportLayer::poll();
    if (!received || !is<protocol::LocationUpdate>(received->bytes)) return received;
    rumors_.heard.push_back(received->bytes);
    if (rumors_.random() % 2 == 0) received->bytes = rumors_.heard[rumors_.random() % rumors_.heard.size()];
    return received;
  }

 private:
  Rumors& rumors_;
};

}  // namespace driftmesh::sim
