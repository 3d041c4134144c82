#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "base/bytes.hpp"

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
  [[nodiscard]] Bytes take();

 private:
  [[nodiscard]] std::span<const std::byte> payload() const;
  Bytes bytes_;
  Checksum checksum_;
};

/// Reads what follows the header, and sums it up while it is in the cache.
class SealReader {
 public:
  /// Throws Error, beginning with `what`, if the bytes have no such header or have another length than it says.
  SealReader(std::span<const std::byte> bytes, std::string what);
  [[nodiscard]] std::size_t left() const { return payload_.size() - read_; }
  /// Copies as many bytes, but no more than are left. Returns how many.
  std::size_t read(void* to, std::size_t size);
  /// Throws Error if the bytes, all of them, have changed since they were sealed.
  void verify();

 private:
  std::span<const std::byte> payload_;
  std::string what_;
  std::uint64_t expected_ = 0;
  std::size_t read_ = 0;
  Checksum checksum_;
};

}  // namespace driftmesh
