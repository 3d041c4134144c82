#pragma once

#include <string>

#include "driftmesh/error.hpp"
#include "driftmesh/ids.hpp"

namespace driftmesh::protocol {

/// A message that breaks the protocol: damaged, truncated, of another version, or one that its sender must not send.
/// The run cannot go on: the message names the sender, and every rank stops.
class ProtocolError : public Error {
 public:
  ProtocolError(Rank sender, const std::string& what)
      : Error("message from rank " + to_string(sender) + ": " + what), sender_(sender) {}
  [[nodiscard]] Rank sender() const { return sender_; }

 private:
  Rank sender_;
};

/// Returns the result of `read`, which reads a message from `sender`; turns an Error into a ProtocolError that names
/// the sender.
template <class Read>
auto read_from(Rank sender, const Read& read) {
  try {
    return read();
  } catch (const Error& error) {
    throw ProtocolError(sender, error.what());
  }
}

}  // namespace driftmesh::protocol
