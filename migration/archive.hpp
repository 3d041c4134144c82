#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "driftmesh/error.hpp"
#include "migration/packed_bytes.hpp"
#include "migration/raw_archive.hpp"

// Values and flat arrays as they are in memory. An array is its length in 8 bytes, then its elements.
namespace driftmesh {

/// What is stored as it is in memory: numbers, and structures without padding, which are added where they are stored.
template <class T>
inline constexpr bool kIsFlat = std::is_arithmetic_v<T> || std::is_enum_v<T> || std::is_same_v<T, std::byte>;

/// Saves values and arrays; an ArchiveReader loads them in the same order.
class ArchiveWriter {
 public:
  explicit ArchiveWriter(SealedBytes& bytes) : raw_(bytes) {}

  template <class T>
  void value(const T& v) {
    static_assert(kIsFlat<T>);
    raw_.save(&v, sizeof v);
  }
  template <class Array>
  void array(const Array& values) {
    using T = std::remove_cvref_t<decltype(*values.data())>;
    static_assert(kIsFlat<T>);
    value(static_cast<std::uint64_t>(values.size()));
    if (!values.empty()) raw_.save(values.data(), values.size() * sizeof(T));
  }

 private:
  RawWriter raw_;
};

/// Throws Error if there are fewer bytes than an array or value needs, before memory is allocated.
class ArchiveReader {
 public:
  explicit ArchiveReader(SealReader& bytes) : bytes_(bytes), raw_(bytes) {}

  template <class T>
  void value(T& v) {
    static_assert(kIsFlat<T>);
    expect(1, sizeof v);
    raw_.load(&v, sizeof v);
  }
  template <class Array>
  void array(Array& values) {
    using T = std::remove_cvref_t<decltype(*values.data())>;
    static_assert(kIsFlat<T>);
    std::uint64_t count = 0;
    value(count);
    expect(count, sizeof(T));
    if constexpr (requires { values.resize_uninitialized(count); })
      values.resize_uninitialized(count);
    else
      values.resize(count);
    if (count != 0) raw_.load(values.data(), count * sizeof(T));
  }
  [[nodiscard]] bool at_end() const { return bytes_.left() == 0; }

 private:
  void expect(std::uint64_t count, std::size_t size) const {
    if (count > bytes_.left() / size) throw Error("an array is longer than the bytes that are left");
  }
  SealReader& bytes_;
  RawReader raw_;
};

}  // namespace driftmesh
