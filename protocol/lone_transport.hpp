#pragma once

#include <chrono>
#include <deque>
#include <string>
#include <utility>

#include "driftmesh/error.hpp"
#include "protocol/transport.hpp"

namespace driftmesh::protocol {

/// The transport of a single rank, which can send only to itself.
class LoneTransport final : public Transport {
 public:
  [[nodiscard]] Rank rank() const override { return kSelf; }
  [[nodiscard]] std::int32_t ranks() const override { return 1; }
  void send(Rank destination, Bytes bytes) override {
    if (destination != kSelf) throw LimitError("there is no rank " + to_string(destination) + ": rank 0 is alone");
    sent_.push_back({kSelf, std::move(bytes)});
  }
  std::optional<Received> poll() override {
    if (sent_.empty()) return std::nullopt;
    Received first = std::move(sent_.front());
    sent_.pop_front();
    return first;
  }
  void idle() override {}
  [[nodiscard]] double now() const override {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  }

 private:
  static constexpr Rank kSelf{0};
  std::deque<Received> sent_;
};

}  // namespace driftmesh::protocol
