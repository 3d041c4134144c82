#pragma once

#include "balancer/snapshot/messages.hpp"
#include "protocol/messages.hpp"
#include "protocol/wire.hpp"

namespace driftmesh::balancer {

/// Encodes a message as advice: the topic is Message's index, the content the fields in the order of messages.hpp,
/// little-endian, lists preceded by a 4-byte count. Every message has exactly one encoding. Throws LimitError for a
/// list of more than 2^32 - 1 items.
[[nodiscard]] protocol::Advice encode(const Message& message);

/// Decodes advice. No length is trusted before the bytes for it are known to be there, and no number before it is in
/// range: anything but the encoding of a message within `limits` is a ProtocolError that names `sender`.
[[nodiscard]] Message decode(Rank sender, const protocol::Advice& advice, const protocol::WireLimits& limits);

}  // namespace driftmesh::balancer
