#pragma once

#include <span>

#include "protocol/ids.hpp"
#include "protocol/messages.hpp"
#include "protocol/protocol_error.hpp"

namespace driftmesh::protocol {

inline constexpr std::uint8_t kWireVersion = 1;

/// What numbers in a message may name: all below these, none negative.
struct WireLimits {
  std::int32_t ranks = 0;
  std::int32_t subdomains = 0;
  std::int32_t roots = 0;  ///< of the decomposition
};

/// The bytes of a message: a byte for the version, a byte for the type (Message's index), then the fields in the order
/// of messages.hpp, little-endian, lists with a 4-byte count in front. Every message has exactly one encoding.
/// Throws LimitError for a list of more than 2^32 - 1 items.
[[nodiscard]] Bytes encode(const Message& message);

/// The message that `bytes` hold. No length in them is believed before the bytes for it are known to be there, and no
/// number before it is in range: anything but the encoding of a message within `limits` is a ProtocolError that names
/// `sender`.
[[nodiscard]] Message decode(Rank sender, std::span<const std::byte> bytes, const WireLimits& limits);

/// The traffic class of an encoded message, without looking further than its type. Throws like decode.
[[nodiscard]] Traffic traffic_of(Rank sender, std::span<const std::byte> bytes);

/// How many bytes of its message a group of SPLITs takes besides its points, and each of these.
inline constexpr std::size_t kSplitGroupBytes = 20;
inline constexpr std::size_t kSplitPointBytes = 12;

}  // namespace driftmesh::protocol
