#pragma once

#include <optional>

#include "base/bytes.hpp"
#include "driftmesh/ids.hpp"

namespace driftmesh::protocol {

struct Received {
  Rank source{};
  Bytes bytes;
};

/// How one rank reaches the others. Every message arrives exactly once and unchanged; nothing is promised about order,
/// not even between two ranks. tests/protocol/transport_contract.hpp is the contract, run against each implementation.
class Transport {
 public:
  virtual ~Transport() = default;
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;

  [[nodiscard]] virtual Rank rank() const = 0;
  [[nodiscard]] virtual std::int32_t ranks() const = 0;

  /// Sends `bytes` (none is allowed) and returns without waiting for anybody. A rank may send to itself. Throws
  /// LimitError for a destination that does not exist or a message too long for the transport.
  virtual void send(Rank destination, Bytes bytes) = 0;

  /// A message that has arrived, if any. Returns without waiting.
  virtual std::optional<Received> poll() = 0;

  /// A hint that this rank has nothing to do until a message arrives: lets others have the core.
  virtual void idle() = 0;

  /// Seconds since some moment in the past, never going back; on simulated ranks, of simulated time.
  [[nodiscard]] virtual double now() const = 0;

  /// States that work was done which a rank of the reference machine needs `seconds` for. Real time passes by itself
  /// and makes this a no-op; simulated time passes by it.
  virtual void spend(double seconds) { static_cast<void>(seconds); }

 protected:
  Transport() = default;
};

}  // namespace driftmesh::protocol
