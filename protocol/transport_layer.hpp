#pragma once

#include <optional>
#include <utility>

#include "protocol/transport.hpp"

namespace driftmesh::protocol {

/// Forwards to another transport; derived classes change or observe the messages.
class TransportLayer : public Transport {
 public:
  /// `inner` must outlive this one.
  explicit TransportLayer(Transport& inner) : inner_(inner) {}

  [[nodiscard]] Rank rank() const override { return inner_.rank(); }
  [[nodiscard]] std::int32_t ranks() const override { return inner_.ranks(); }
  void send(Rank destination, Bytes bytes) override { inner_.send(destination, std::move(bytes)); }
  std::optional<Received> poll() override { return inner_.poll(); }
  void idle() override { inner_.idle(); }
  [[nodiscard]] double now() const override { return inner_.now(); }
  void spend(double seconds) override { inner_.spend(seconds); }

 private:
  Transport& inner_;
};

}  // namespace driftmesh::protocol
