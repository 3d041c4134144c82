#pragma once

#include <optional>

#include "base/bytes.hpp"
#include "driftmesh/ids.hpp"

namespace driftmesh::protocol {

struct Received {
  Rank source{};
  Bytes bytes;
};

/// Communication of one rank with the others. Every message arrives exactly once and unchanged; no order is guaranteed,
/// not even between two ranks. tests/protocol/transport_contract.hpp is the contract, tested on each implementation.
class Transport {
 public:
  virtual ~Transport() = default;
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;

  [[nodiscard]] virtual Rank rank() const = 0;
  [[nodiscard]] virtual std::int32_t ranks() const = 0;

  /// Sends `bytes` (may be empty) and returns without waiting. A rank may send to itself. Throws LimitError for a
  /// destination that does not exist or a message too long for the transport.
  virtual void send(Rank destination, Bytes bytes) = 0;

  /// An arrived message, if any. Returns without waiting.
  virtual std::optional<Received> poll() = 0;

  /// A hint that this rank has nothing to do until a message arrives: yields the core to others.
  virtual void idle() = 0;

  /// Monotonic time in seconds since some moment in the past; simulated time on simulated ranks.
  [[nodiscard]] virtual double now() const = 0;

  /// Accounts for work that takes `seconds` on the reference machine. A no-op in real time; advances simulated time.
  virtual void spend(double seconds) { static_cast<void>(seconds); }

 protected:
  Transport() = default;
};

}  // namespace driftmesh::protocol
