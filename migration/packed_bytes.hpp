#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "protocol/ids.hpp"

namespace driftmesh {

/// What stands before a packed form, so that anything else is told from it.
struct PackedHeader {
  static constexpr std::uint64_t kMagic = 0x4B43415048534D44;  ///< "DMSHPACK" where the lowest byte comes first
  static constexpr std::uint32_t kVersion = 1;
  std::uint64_t magic = kMagic;
  std::uint32_t version = kVersion;
  std::uint32_t reserved = 0;
  std::uint64_t length = 0;    ///< of what follows the header, bytes
  std::uint64_t checksum = 0;  ///< of what follows the header
};

/// A checksum made for memory speed: in each of eight lanes of 64 bits, the sum of the words and the sum of these sums
/// (Fletcher 1982, with longer words), mixed in the end. Finds every change within one word, and others but for a
/// chance of about 2^-64. No defence against forgery.
class Checksum {
 public:
  /// Takes in what `bytes`, which has grown since the last call, has more in whole blocks.
  void catch_up(std::span<const std::byte> bytes);
  /// Of all bytes, including those of the last block.
  [[nodiscard]] std::uint64_t of(std::span<const std::byte> bytes);

 private:
  static constexpr std::size_t kLanes = 8;
  using Words = std::array<std::uint64_t, kLanes>;

  std::size_t taken_in_ = 0;  // bytes
  Words sum_{}, sum_of_sums_{};
};

/// Bytes that grow behind a header and are summed up while they are in the cache.
class SealedBytes {
 public:
  /// `capacity`: what to make room for at once.
  explicit SealedBytes(std::size_t capacity);
  void append(const void* data, std::size_t size);
  /// The bytes with the header that goes with them.
  [[nodiscard]] protocol::Bytes take();

 private:
  [[nodiscard]] std::span<const std::byte> payload() const;
  protocol::Bytes bytes_;
  Checksum checksum_;
};

/// What follows the header. Throws Error, beginning with `what`, for bytes that were not sealed or have changed since.
[[nodiscard]] std::span<const std::byte> open_sealed(std::span<const std::byte> bytes, const std::string& what);

}  // namespace driftmesh
