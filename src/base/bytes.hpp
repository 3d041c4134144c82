#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "driftmesh/error.hpp"

namespace driftmesh {

using Bytes = std::vector<std::byte>;

template <class T>
concept Number = (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>) || std::is_enum_v<T>;

/// The unsigned integer of a type's size: 1, 2, 4 or 8 bytes.
template <std::size_t size>
using UnsignedOfSize = std::conditional_t<
    size == 1, std::uint8_t,
    std::conditional_t<size == 2, std::uint16_t, std::conditional_t<size == 4, std::uint32_t, std::uint64_t>>>;

/// Appends to bytes what a ByteReader takes out again, in the same order.
///
/// Numbers have a fixed layout, the same on every machine. Values and arrays are copied as they are in memory, for
/// processes of the same program on machines of the same kind. Data that is stored, or comes from elsewhere, has
/// formats of its own.
class ByteWriter {
 public:
  /// Behind these bytes, if there are some.
  explicit ByteWriter(Bytes bytes = {}) : bytes_(std::move(bytes)) {}

  /// The bytes of a T, lowest first; a floating-point number as its IEEE 754 bits.
  template <Number T>
  void number(T value) {
    const auto bits = std::bit_cast<UnsignedOfSize<sizeof(T)>>(value);
    std::array<std::byte, sizeof(T)> little_endian;
    for (std::size_t i = 0; i < sizeof(T); ++i) little_endian[i] = static_cast<std::byte>(bits >> (8 * i) & 0xff);
    append(little_endian.data(), sizeof(T));
  }
  /// Few bytes for small numbers: seven bits per byte, lowest first, the high bit set except in the last byte (LEB128,
  /// as in DWARF).
  void varint(std::uint64_t n) {
    for (; n >= 0x80; n >>= 7) bytes_.push_back(static_cast<std::byte>(n | 0x80));
    bytes_.push_back(static_cast<std::byte>(n));
  }
  /// Few bytes for numbers of small magnitude: the sign is the lowest bit.
  void signed_varint(std::int64_t n) {
    varint((static_cast<std::uint64_t>(n) << 1) ^ static_cast<std::uint64_t>(n >> 63));
  }
  /// Bytes without their length.
  void raw(std::span<const std::byte> bytes) { append(bytes.data(), bytes.size()); }

  template <class T>
  void value(const T& v) {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
    append(&v, sizeof v);
  }
  template <class T>
  void array(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
    number(std::uint64_t{values.size()});
    append(values.data(), values.size_bytes());
  }
  template <class T>
  void array(const std::vector<T>& values) {
    array(std::span<const T>(values));
  }
  void text(const std::string& s) { array(std::span<const char>(s)); }

  void reserve(std::size_t more) { bytes_.reserve(bytes_.size() + more); }
  [[nodiscard]] Bytes& bytes() { return bytes_; }
  [[nodiscard]] Bytes take() { return std::move(bytes_); }

 private:
  void append(const void* data, std::size_t size);

  Bytes bytes_;
};

/// Reads what a ByteWriter wrote, from front to back. Throws Error for invalid bytes, with a message about them ("it
/// ends too early") that callers who know their source can complete. A length is trusted only after checking that there
/// are enough bytes.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <Number T>
  [[nodiscard]] T number() {
    using Bits = UnsignedOfSize<sizeof(T)>;
    const auto taken = raw(sizeof(T));
    Bits bits = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i)
      bits = static_cast<Bits>(bits | static_cast<Bits>(std::to_integer<Bits>(taken[i]) << (8 * i)));
    return std::bit_cast<T>(bits);
  }
  /// Throws Error also for numbers of more than 64 bits.
  [[nodiscard]] std::uint64_t varint() {
    std::uint64_t n = 0;
    for (int shift = 0; shift < 64; shift += 7) {
      const auto b = std::to_integer<std::uint64_t>(raw(1)[0]);
      n |= (b & 0x7F) << shift;
      if (b < 0x80) return n;
    }
    throw Error("it has a number that is too long");
  }
  [[nodiscard]] std::int64_t signed_varint() {
    const std::uint64_t n = varint();
    return static_cast<std::int64_t>((n >> 1) ^ (0 - (n & 1)));
  }
  /// The next `size` bytes, which live as long as those that are read.
  std::span<const std::byte> raw(std::size_t size) {
    if (size > bytes_.size()) throw Error("it ends too early");
    const auto taken = bytes_.first(size);
    bytes_ = bytes_.subspan(size);
    return taken;
  }

  template <class T>
  void value(T& v) {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
    copy_to(&v, sizeof v);
  }
  template <class T>
  [[nodiscard]] T value() {
    T v{};
    value(v);
    return v;
  }
  template <class T>
  void array(std::vector<T>& values) {
    const auto count = number<std::uint64_t>();
    if (count > bytes_.size() / sizeof(T)) throw Error("it ends too early");
    values.resize(count);
    copy_to(values.data(), count * sizeof(T));
  }
  [[nodiscard]] std::string text() {
    std::vector<char> characters;
    array(characters);
    return {characters.begin(), characters.end()};
  }

  [[nodiscard]] std::size_t left() const { return bytes_.size(); }
  [[nodiscard]] bool at_end() const { return bytes_.empty(); }
  /// Throws Error if anything is left.
  void end() const {
    if (!at_end()) throw Error("it goes on after its end");
  }

 private:
  void copy_to(void* data, std::size_t size) {
    const auto taken = raw(size);
    if (size != 0) std::memcpy(data, taken.data(), size);
  }
  std::span<const std::byte> bytes_;
};

}  // namespace driftmesh
