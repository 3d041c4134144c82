#pragma once

#include <optional>
#include <utility>

#include "protocol/transport.hpp"

namespace driftmesh::sim {

/// Another transport as it is. What derives from it changes, or looks at, what passes.
class TransportLayer : public protocol::Transport {
 public:
  /// `inner` must outlive this one.
  explicit TransportLayer(protocol::Transport& inner) : inner_(inner) {}

  [[nodiscard]] protocol::Rank rank() const override { return inner_.rank(); }
  [[nodiscard]] protocol::Rank ranks() const override { return inner_.ranks(); }
  void send(protocol::Rank destination, protocol::Bytes bytes) override { inner_.send(destination, std::move(bytes)); }
  std::optional<protocol::Received> poll() override { return inner_.poll(); }
  void idle() override { inner_.idle(); }
  [[nodiscard]] double now() const override { return inner_.now(); }
  void spend(double seconds) override { inner_.spend(seconds); }

 private:
  protocol::Transport& inner_;
};

}  // namespace driftmesh::sim
