#pragma once

#include "balancer/messages.hpp"
#include "protocol/messages.hpp"
#include "protocol/wire.hpp"

namespace driftmesh::balancer {

/// The message as advice: its topic is Message's index, its content the fields in the order of messages.hpp,
/// little-endian, lists with a 4-byte count in front. Every message has exactly one encoding. Throws LimitError for a
/// list of more than 2^32 - 1 items.
[[nodiscard]] protocol::Advice encode(const Message& message);

/// The message that the advice is. No length in it is believed before the bytes for it are known to be there, and no
/// number before it is in range: anything but the encoding of a message within `limits` is a ProtocolError that names
/// `sender`.
[[nodiscard]] Message decode(Rank sender, const protocol::Advice& advice, const protocol::WireLimits& limits);

}  // namespace driftmesh::balancer
