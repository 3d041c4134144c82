#pragma once

#include <span>

#include "protocol/messages.hpp"
#include "protocol/protocol_error.hpp"
#include "protocol/wire.hpp"

namespace driftmesh::protocol {

inline constexpr std::uint8_t kWireVersion = 2;

/// The bytes of a message: one byte for the version, one for the type, then the fields in the order of messages.hpp,
/// little-endian, lists preceded by a 4-byte count. The type is Message's index, plus the topic for advice. Every
/// message has exactly one encoding. Throws LimitError for a list of more than 2^32 - 1 items, and for a topic of
/// advice that has no room in a byte.
[[nodiscard]] Bytes encode(const Message& message);

/// The message encoded in `bytes`. No length is trusted before the bytes for it are known to be there, and no number
/// before it is in range: anything but the encoding of a message within `limits` is a ProtocolError that names
/// `sender`. The content of advice is not examined.
[[nodiscard]] Message decode(Rank sender, std::span<const std::byte> bytes, const WireLimits& limits);

/// The traffic class of an encoded message, from its type alone. Throws like decode.
[[nodiscard]] Traffic traffic_of(Rank sender, std::span<const std::byte> bytes);

/// Bytes of a group of SPLITs without its points, and bytes per point.
inline constexpr std::size_t kSplitGroupBytes = 20;
inline constexpr std::size_t kSplitPointBytes = 12;

}  // namespace driftmesh::protocol
