#pragma once

#include <algorithm>
#include <bit>
#include <charconv>
#include <concepts>
#include <cstring>
#include <memory>
#include <ranges>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "base/atomic_file.hpp"

namespace driftmesh {

static_assert(std::endian::native == std::endian::little, "binary mesh files are written in the machine's byte order");

/// Writes numbers to a file, as text or as raw bytes, in large blocks. The file appears under its name when commit() is
/// called. Errors: FileError.
class FileSink {
 public:
  explicit FileSink(const std::string& path) : file_(path), buffer_(std::make_unique_for_overwrite<char[]>(kBytes)) {}

  void text(std::string_view characters) { bytes(characters.data(), characters.size()); }
  void character(char c) { *room(1) = c, ++used_; }

  /// The shortest text that reads back as the same value.
  template <class Number>
  requires std::integral<Number> || std::floating_point<Number>
  void number(Number value) {
    char* const begin = room(kLongestNumber);
    used_ += static_cast<std::size_t>(std::to_chars(begin, begin + kLongestNumber, value).ptr - begin);
  }

  /// A line of numbers with blanks between them. A range stands for its numbers.
  template <class... Items>
  void line(const Items&... items) {
    bool is_first = true;
    const auto field = [&](auto value) {
      if (!std::exchange(is_first, false)) character(' ');
      number(value);
    };
    const auto fields = [&](const auto& item) {
      if constexpr (std::ranges::range<decltype(item)>)
        std::ranges::for_each(item, field);
      else
        field(item);
    };
    (fields(items), ...);
    character('\n');
  }

  /// The value's bytes in memory.
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void raw(const T& value) {
    std::memcpy(room(sizeof(T)), &value, sizeof(T));
    used_ += sizeof(T);
  }
  /// value(i) for each i below `count`, as raw does one by one.
  template <class Value>
  void raw_values(std::size_t count, const Value& value) {
    using T = std::decay_t<decltype(value(std::size_t{0}))>;
    static_assert(std::is_trivially_copyable_v<T>);
    for (std::size_t begin = 0; begin < count;) {
      char* const out = room(sizeof(T));
      const std::size_t now = std::min(count - begin, (kBytes - used_) / sizeof(T));
      for (std::size_t i = 0; i < now; ++i) {
        const T one = value(begin + i);
        std::memcpy(out + i * sizeof(T), &one, sizeof(T));
      }
      used_ += now * sizeof(T);
      begin += now;
    }
  }
  /// The bytes of all values; many of them bypass the buffer.
  template <class T>
  void raw_array(std::span<const T> values) {
    bytes(values.data(), values.size_bytes());
  }

  [[nodiscard]] std::uint64_t size() const { return file_.size() + used_; }

  void commit() {
    flush();
    file_.commit();
  }

 private:
  static constexpr std::size_t kBytes = std::size_t{1} << 20;
  static constexpr std::size_t kLongestNumber = 32;

  char* room(std::size_t count) {
    if (kBytes - used_ < count) flush();
    return buffer_.get() + used_;
  }
  void bytes(const void* data, std::size_t count) {
    if (kBytes - used_ < count) flush();
    if (count >= kBytes) return file_.write(data, count);
    if (count == 0) return;
    std::memcpy(buffer_.get() + used_, data, count);
    used_ += count;
  }
  void flush() {
    file_.write(buffer_.get(), used_);
    used_ = 0;
  }

  AtomicFile file_;
  std::unique_ptr<char[]> buffer_;
  std::size_t used_ = 0;
};

}  // namespace driftmesh
