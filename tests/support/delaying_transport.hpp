#pragma once

#include <random>
#include <vector>

#include "protocol/transport_layer.hpp"

namespace driftmesh::protocol {

/// Makes another transport unpleasant: received messages are kept for a random number of polls and delivered in random
/// order. For tests of real ranks, whose messages otherwise arrive sooner, and in better order, than on a busy network.
class DelayingTransport final : public TransportLayer {
 public:
  /// Messages wait up to `longest` polls each. The inner transport must outlive this one.
  DelayingTransport(Transport& inner, std::uint64_t seed, std::uint64_t longest);

  std::optional<Received> poll() override;
  void idle() override;

 private:
  struct Kept {
    std::uint64_t until;  // poll
    Received message;
  };

  std::mt19937_64 random_;
  std::uint64_t longest_;
  std::uint64_t polls_ = 0;
  std::vector<Kept> kept_;
};

}  // namespace driftmesh::protocol
