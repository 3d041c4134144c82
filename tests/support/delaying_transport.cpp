#include "support/delaying_transport.hpp"

#include <algorithm>
#include <utility>

namespace driftmesh::protocol {

DelayingTransport::DelayingTransport(Transport& inner, std::uint64_t seed, std::uint64_t longest)
    : TransportLayer(inner), random_(seed + static_cast<std::uint64_t>(to_int(inner.rank()))), longest_(longest) {}

std::optional<Received> DelayingTransport::poll() {
  ++polls_;
  while (auto message = TransportLayer::poll())
    kept_.push_back({polls_ + random_() % (longest_ + 1), std::move(*message)});
  const auto due = std::find_if(kept_.begin(), kept_.end(), [&](const Kept& kept) { return kept.until <= polls_; });
  if (due == kept_.end()) return std::nullopt;
  Received message = std::move(due->message);
  kept_.erase(due);
  return message;
}

// While messages are held, only polls are needed, so do not idle.
void DelayingTransport::idle() {
  if (kept_.empty()) TransportLayer::idle();
}

}  // namespace driftmesh::protocol
