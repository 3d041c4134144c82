#pragma once

#include <span>

#include "protocol/messages.hpp"
#include "protocol/protocol_error.hpp"
#include "protocol/wire.hpp"

namespace driftmesh::protocol {

inline constexpr std::uint8_t kWireVersion = 2;

/// The bytes of a message: a byte for the version, a byte for the type, then the fields in the order of messages.hpp,
/// little-endian, lists with a 4-byte count in front. The type is Message's index; of advice its topic is added to
/// that. Every message has exactly one encoding. Throws LimitError for a list of more than 2^32 - 1 items, and for a
/// topic of advice that has no room in a byte.
[[nodiscard]] Bytes encode(const Message& message);

/// The message that `bytes` hold. No length in them is believed before the bytes for it are known to be there, and no
/// number before it is in range: anything but the encoding of a message within `limits` is a ProtocolError that names
/// `sender`. What advice says is not looked at.
[[nodiscard]] Message decode(Rank sender, std::span<const std::byte> bytes, const WireLimits& limits);

/// The traffic class of an encoded message, without looking further than its type. Throws like decode.
[[nodiscard]] Traffic traffic_of(Rank sender, std::span<const std::byte> bytes);

/// How many bytes of its message a group of SPLITs takes besides its points, and each of these.
inline constexpr std::size_t kSplitGroupBytes = 20;
inline constexpr std::size_t kSplitPointBytes = 12;

}  // namespace driftmesh::protocol
