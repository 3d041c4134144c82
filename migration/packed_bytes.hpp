#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "base/bytes.hpp"

namespace driftmesh {

/// The header of a packed form, which distinguishes it from anything else.
struct PackedHeader {
  static constexpr std::uint64_t kMagic = 0x4B43415048534D44;  ///< "DMSHPACK" where the lowest byte comes first
  static constexpr std::uint32_t kVersion = 1;
  std::uint64_t magic = kMagic;
  std::uint32_t version = kVersion;
  std::uint32_t reserved = 0;
  std::uint64_t length = 0;    ///< bytes that follow the header
  std::uint64_t checksum = 0;  ///< checksum of what follows the header
};

/// A checksum made for memory speed: in each of eight lanes of 64 bits, the sum of the words and the sum of these sums
/// (Fletcher 1982, with longer words), mixed in the end. Detects every change within one word, and misses others with a
/// probability of about 2^-64. No defense against forgery.
class Checksum {
 public:
  /// Adds the whole blocks by which `bytes` has grown since the last call.
  void catch_up(std::span<const std::byte> bytes);
  /// The checksum of all bytes, including those of the last block.
  [[nodiscard]] std::uint64_t of(std::span<const std::byte> bytes);

 private:
  static constexpr std::size_t kLanes = 8;
  using Words = std::array<std::uint64_t, kLanes>;

  std::size_t taken_in_ = 0;  // bytes
  Words sum_{}, sum_of_sums_{};
};

/// Bytes appended after a header, and summed up while they are in the cache.
class SealedBytes {
 public:
  /// `capacity`: bytes to reserve.
  explicit SealedBytes(std::size_t capacity);
  /// Only counts what is appended.
  [[nodiscard]] static SealedBytes counted();
  void append(const void* data, std::size_t size);
  /// With the header.
  [[nodiscard]] std::uint64_t size() const { return counted_ > 0 ? counted_ : bytes_.size(); }
  /// The bytes with their header.
  [[nodiscard]] Bytes take();

 private:
  [[nodiscard]] std::span<const std::byte> payload() const;
  std::uint64_t counted_ = 0;  // 0: they are not only counted
  Bytes bytes_;
  Checksum checksum_;
};

/// Reads the payload after the header, and sums it up while it is in the cache.
class SealReader {
 public:
  /// Throws Error, starting with `what`, if the bytes have no such header or do not have the length that it says.
  SealReader(std::span<const std::byte> bytes, std::string what);
  [[nodiscard]] std::size_t left() const { return payload_.size() - read_; }
  /// Copies this many bytes, or as many as are left. Returns the number.
  std::size_t read(void* to, std::size_t size);
  /// Throws Error if any of the bytes have changed since they were sealed.
  void verify();

 private:
  std::span<const std::byte> payload_;
  std::string what_;
  std::uint64_t expected_ = 0;
  std::size_t read_ = 0;
  Checksum checksum_;
};

}  // namespace driftmesh
