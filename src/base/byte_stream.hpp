#pragma once

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

/// Flat values and arrays of them as bytes, as they lie in memory. For exchange between processes of one program on
/// machines of one kind; what lasts, or comes from strangers, has formats of its own.
class ByteWriter {
 public:
  template <class T>
  void value(const T& v) {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
    append(&v, sizeof v);
  }
  template <class T>
  void array(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
    value(static_cast<std::uint64_t>(values.size()));
    append(values.data(), values.size_bytes());
  }
  template <class T>
  void array(const std::vector<T>& values) {
    array(std::span<const T>(values));
  }
  void text(const std::string& s) { array(std::span<const char>(s)); }
  [[nodiscard]] std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  void append(const void* data, std::size_t size) {
    if (size == 0) return;
    const std::size_t old = bytes_.size();
    bytes_.resize(old + size);
    std::memcpy(bytes_.data() + old, data, size);
  }
  std::vector<std::byte> bytes_;
};

/// Reads what a ByteWriter wrote, in the same order. Throws Error when the bytes end too early.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <class T>
  void value(T& v) {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
    take(&v, sizeof v);
  }
  template <class T>
  T value() {
    T v{};
    value(v);
    return v;
  }
  template <class T>
  void array(std::vector<T>& values) {
    const auto count = value<std::uint64_t>();
    if (count > bytes_.size() / sizeof(T)) throw_short();
    values.resize(count);
    take(values.data(), count * sizeof(T));
  }
  [[nodiscard]] std::string text() {
    std::vector<char> characters;
    array(characters);
    return {characters.begin(), characters.end()};
  }
  [[nodiscard]] bool at_end() const { return bytes_.empty(); }

 private:
  void take(void* data, std::size_t size) {
    if (size > bytes_.size()) throw_short();
    if (size != 0) std::memcpy(data, bytes_.data(), size);
    bytes_ = bytes_.subspan(size);
  }
  [[noreturn]] static void throw_short() {
    throw Error("a message between ranks is too short: are all of one version?");
  }

  std::span<const std::byte> bytes_;
};

}  // namespace driftmesh
