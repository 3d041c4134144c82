#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "driftmesh/error.hpp"

namespace driftmesh {

/// Appends numbers of few bytes where they are small: seven bits a byte, low ones first, the high bit set but in the
/// last byte (LEB128, as in DWARF).
class VarintWriter {
 public:
  explicit VarintWriter(std::vector<std::byte>& bytes) : bytes_(bytes) {}
  void put(std::uint64_t n) {
    for (; n >= 0x80; n >>= 7) bytes_.push_back(static_cast<std::byte>(n | 0x80));
    bytes_.push_back(static_cast<std::byte>(n));
  }
  /// Small in magnitude: the sign goes into the lowest bit.
  void put_signed(std::int64_t n) { put((static_cast<std::uint64_t>(n) << 1) ^ static_cast<std::uint64_t>(n >> 63)); }

 private:
  std::vector<std::byte>& bytes_;
};

/// Takes them out again. Throws Error at the end of the bytes, and for numbers of more than 64 bits.
class VarintReader {
 public:
  explicit VarintReader(std::span<const std::byte> bytes) : bytes_(bytes) {}
  [[nodiscard]] std::byte byte() {
    if (bytes_.empty()) throw Error("a list of numbers ends too early");
    const std::byte b = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return b;
  }
  [[nodiscard]] std::uint64_t get() {
    std::uint64_t n = 0;
    for (int shift = 0; shift < 64; shift += 7) {
      const auto b = std::to_integer<std::uint64_t>(byte());
      n |= (b & 0x7F) << shift;
      if (b < 0x80) return n;
    }
    throw Error("a number in a list is too long");
  }
  [[nodiscard]] std::int64_t get_signed() {
    const std::uint64_t n = get();
    return static_cast<std::int64_t>((n >> 1) ^ (0 - (n & 1)));
  }
  [[nodiscard]] bool at_end() const { return bytes_.empty(); }

 private:
  std::span<const std::byte> bytes_;
};

}  // namespace driftmesh
