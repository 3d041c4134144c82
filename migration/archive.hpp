#pragma once

#include <boost/archive/archive_exception.hpp>
#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/serialization/array_wrapper.hpp>
#include <boost/serialization/is_bitwise_serializable.hpp>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <streambuf>
#include <string>
#include <type_traits>

#include "driftmesh/error.hpp"
#include "migration/packed_bytes.hpp"

// Boost's binary archives on bytes in memory, for values and flat arrays of trivially copyable values. An array is
// stored as one block.

BOOST_IS_BITWISE_SERIALIZABLE(std::byte)

namespace driftmesh {

inline constexpr unsigned kArchiveFlags = boost::archive::no_header | boost::archive::no_codecvt;

/// Allowed array elements: Boost would otherwise serialize element by element, and turn enumerators into ints.
template <class T>
inline constexpr bool kIsFlat = boost::serialization::is_bitwise_serializable<T>::value;

/// A stream that appends to sealed bytes.
class ByteSink : public std::streambuf {
 public:
  explicit ByteSink(SealedBytes& bytes) : bytes_(bytes) {}

 protected:
  std::streamsize xsputn(const char* data, std::streamsize size) override {
    bytes_.append(data, static_cast<std::size_t>(size));
    return size;
  }
  int_type overflow(int_type c) override {
    const char byte = traits_type::to_char_type(c);
    bytes_.append(&byte, 1);
    return c;
  }

 private:
  SealedBytes& bytes_;
};

/// A stream that reads sealed bytes.
class ByteSource : public std::streambuf {
 public:
  explicit ByteSource(SealReader& bytes) : bytes_(bytes) {}

 protected:
  std::streamsize xsgetn(char* to, std::streamsize size) override {
    return static_cast<std::streamsize>(bytes_.read(to, static_cast<std::size_t>(size)));
  }

 private:
  SealReader& bytes_;
};

/// Saves values and arrays; an ArchiveReader loads them in the same order.
class ArchiveWriter {
 public:
  explicit ArchiveWriter(SealedBytes& bytes) : sink_(bytes), archive_(sink_, kArchiveFlags) {}

  template <class T>
  void value(const T& v) {
    static_assert(kIsFlat<T> || std::is_enum_v<T>);
    archive_.save_binary(&v, sizeof v);
  }
  template <class Array>
  void array(const Array& values) {
    using T = std::remove_cvref_t<decltype(*values.data())>;
    static_assert(kIsFlat<T>);
    value(static_cast<std::uint64_t>(values.size()));
    if (!values.empty()) archive_ << boost::serialization::make_array(values.data(), values.size());
  }

 private:
  ByteSink sink_;
  boost::archive::binary_oarchive archive_;
};

/// Throws Error if there are fewer bytes than an array or value needs, before memory is allocated.
class ArchiveReader {
 public:
  explicit ArchiveReader(SealReader& bytes) : bytes_(bytes), source_(bytes), archive_(source_, kArchiveFlags) {}

  template <class T>
  void value(T& v) {
    static_assert(kIsFlat<T> || std::is_enum_v<T>);
    expect(1, sizeof v);
    archive_.load_binary(&v, sizeof v);
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
    if (count != 0) archive_ >> boost::serialization::make_array(values.data(), count);
  }
  [[nodiscard]] bool at_end() const { return bytes_.left() == 0; }

 private:
  void expect(std::uint64_t count, std::size_t size) const {
    if (count > bytes_.left() / size) throw Error("an array is longer than the bytes that are left");
  }
  SealReader& bytes_;
  ByteSource source_;
  boost::archive::binary_iarchive archive_;
};

}  // namespace driftmesh
