#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/from_chars.hpp"
#include "base/huge_pages.hpp"
#include "driftmesh/error.hpp"
#include "io/byte_cursor.hpp"
#include "io/read_checks.hpp"
#include "io/vtu_data.hpp"
#include "io/vtu_header.hpp"

namespace driftmesh {

/// How many words a text has.
[[nodiscard]] inline std::uint64_t words_in(std::string_view text) {
  std::uint64_t words = 0;
  bool inside = false;
  for (const char c : text) {
    words += !inside && !ByteCursor::is_blank(c) ? 1 : 0;
    inside = !ByteCursor::is_blank(c);
  }
  return words;
}

/// The values of an array from first to last, converted to the type that a Mesh has, part by part: memory does not
/// depend on how many there are.
template <class T>
class VtuValues {
 public:
  /// `count` values; all arguments must outlive the object. Throws InputError unless there are as many, for binary
  /// arrays at once.
  VtuValues(const std::string& path, const VtuData& data, const VtuHeader::Array& array, std::uint64_t count)
      : path_(path), array_(array), size_(count), text_(array.text), fill_(filler()) {
    if (array_.format != VtuHeader::Format::kAscii)
      bytes_ = std::make_unique<VtuBytes>(data, array_, count * value_bytes(array_));
    else if (count == 0)
      require_end();
  }

  /// How many bytes a value has in the array. 0: of an unknown type, or as text.
  [[nodiscard]] static std::size_t value_bytes(const VtuHeader::Array& array) {
    for (const auto& [type, size] : {std::pair{"Float64", 8},
                                     {"Float32", 4},
                                     {"Int8", 1},
                                     {"UInt8", 1},
                                     {"Int16", 2},
                                     {"UInt16", 2},
                                     {"Int32", 4},
                                     {"UInt32", 4},
                                     {"Int64", 8},
                                     {"UInt64", 8}})
      if (array.type == type) return static_cast<std::size_t>(size);
    return 0;
  }

  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// How many bytes the values have, and how many of the file hold them.
  [[nodiscard]] std::uint64_t bytes() const { return size_ * value_bytes(array_); }
  [[nodiscard]] std::uint64_t stored() const { return bytes_ != nullptr ? bytes_->stored() : text_.size(); }

  /// The next one; there must be one left, by size(). Throws InputError for damaged data, a value that does not fit,
  /// and, with the last one, for more values than `count`.
  [[nodiscard]] T next() {
    if (at_ == part_.size()) refill();
    return part_[at_++];
  }

  /// Those that are left.
  [[nodiscard]] std::vector<T> all() {
    std::vector<T> values;
    reserve_in_huge_pages(values, size_);
    while (values.size() < size_) {
      if (at_ == part_.size()) refill();
      values.insert(values.end(), part_.begin() + static_cast<std::ptrdiff_t>(at_), part_.end());
      at_ = part_.size();
    }
    return values;
  }

 private:
  using Fill = void (VtuValues::*)();

  [[nodiscard]] Fill filler() const {
    if (array_.type == "Float64") return &VtuValues::fill<double>;
    if (array_.type == "Float32") return &VtuValues::fill<float>;
    if (array_.type == "Int8") return &VtuValues::fill<std::int8_t>;
    if (array_.type == "UInt8") return &VtuValues::fill<std::uint8_t>;
    if (array_.type == "Int16") return &VtuValues::fill<std::int16_t>;
    if (array_.type == "UInt16") return &VtuValues::fill<std::uint16_t>;
    if (array_.type == "Int32") return &VtuValues::fill<std::int32_t>;
    if (array_.type == "UInt32") return &VtuValues::fill<std::uint32_t>;
    if (array_.type == "Int64") return &VtuValues::fill<std::int64_t>;
    if (array_.type == "UInt64") return &VtuValues::fill<std::uint64_t>;
    throw InputError({path_, array_.line}, "DataArray of unknown type '" + array_.type + "'", kSaveVtuAs);
  }

  void refill() {
    part_.clear();
    at_ = 0;
    (this->*fill_)();
    taken_ += part_.size();
    if (bytes_ == nullptr && taken_ == size_) require_end();
  }

  template <class From>
  void fill() {
    if (bytes_ == nullptr) return parse<From>();
    const std::string_view bytes = bytes_->next();
    part_.reserve(bytes.size() / sizeof(From));
    for (std::size_t i = 0; i < bytes.size(); i += sizeof(From)) {
      From value;
      std::memcpy(&value, bytes.data() + i, sizeof(From));
      part_.push_back(checked(value));
    }
  }

  template <class From>
  void parse() {
    constexpr std::size_t kPart = 16'384;
    const std::size_t wanted = std::min<std::uint64_t>(kPart, size_ - taken_);
    for (skip_blanks(); part_.size() < wanted; skip_blanks()) {
      if (text_.empty()) fail_with_count(taken_ + part_.size());
      const char* const end = text_.data() + text_.size();
      From value{};
      const auto [stop, error] = from_chars(text_.data(), end, value);
      if (error != std::errc() || (stop != end && !ByteCursor::is_blank(*stop)))
        throw InputError({path_, array_.line}, "a DataArray holds text that is not " + array_.type, kDamaged);
      part_.push_back(checked(value));
      text_.remove_prefix(static_cast<std::size_t>(stop - text_.data()));
    }
  }

  void skip_blanks() {
    const auto* const word = std::find_if_not(text_.begin(), text_.end(), ByteCursor::is_blank);
    text_.remove_prefix(static_cast<std::size_t>(word - text_.begin()));
  }

  void require_end() {
    skip_blanks();
    if (!text_.empty()) fail_with_count(size_ + words_in(text_));
  }

  [[noreturn]] void fail_with_count(std::uint64_t found) const {
    throw InputError({path_, array_.line},
                     "a DataArray holds " + std::to_string(found) + " values, not " + std::to_string(size_), kDamaged);
  }

  template <class From>
  [[nodiscard]] T checked(From value) const {
    if constexpr (std::is_floating_point_v<T>) {
      return static_cast<T>(value);
    } else if constexpr (std::is_integral_v<From>) {
      if (std::in_range<T>(value)) return static_cast<T>(value);
    }
    throw InputError({path_, array_.line}, "DataArray holds a value that is out of range for its purpose", kDamaged);
  }

  const std::string& path_;
  const VtuHeader::Array& array_;
  std::uint64_t size_;
  std::uint64_t taken_ = 0;  // into parts
  std::string_view text_;    // what is left of values as text
  Fill fill_;
  std::unique_ptr<VtuBytes> bytes_;  // null: the values are text
  std::vector<T> part_;
  std::size_t at_ = 0;
};

/// The arrays of a .vtu by name.
class VtuArrayReader {
 public:
  /// The arguments must outlive the object.
  VtuArrayReader(const std::string& path, const VtuHeader& header)
      : path_(path), header_(header), data_(path, header) {}

  /// Null: there is none.
  [[nodiscard]] const VtuHeader::Array* find(const char* section, const char* name) const {
    const auto found = header_.arrays.find({section, name});
    return found == header_.arrays.end() ? nullptr : &found->second;
  }

  /// Throws InputError if there is none.
  [[nodiscard]] const VtuHeader::Array& get(const char* section, const char* name) const {
    if (const VtuHeader::Array* const array = find(section, name)) return *array;
    throw InputError({path_, 0}, std::string("has no array '") + name + "' in <" + section + ">", kDamaged);
  }

  /// `tuples` x components values, of which there may be `most_components`. Throws InputError if there are more.
  template <class T>
  [[nodiscard]] VtuValues<T> open(const VtuHeader::Array& array, std::uint64_t tuples,
                                  std::uint64_t most_components = 1) const {
    constexpr std::uint64_t kMostTuples = std::uint64_t{1} << 48;  // no array that a machine can hold has more
    if (array.components == 0 || array.components > most_components || tuples > kMostTuples / array.components)
      throw InputError(
          {path_, array.line},
          "a DataArray of " + std::to_string(tuples) + " x " + std::to_string(array.components) + " values", kDamaged);
    return {path_, data_, array, tuples * array.components};
  }

  /// As many values as the array has by itself, of one component.
  template <class T>
  [[nodiscard]] VtuValues<T> open_all(const VtuHeader::Array& array) const {
    if (array.components != 1)
      throw InputError({path_, array.line},
                       "a DataArray of " + std::to_string(array.components) + " components where one is meant",
                       kDamaged);
    if (array.format == VtuHeader::Format::kAscii) return {path_, data_, array, words_in(array.text)};
    const std::size_t size = VtuValues<T>::value_bytes(array);
    return {path_, data_, array, size == 0 ? 0 : data_.announced(array) / size};
  }

 private:
  const std::string& path_;
  const VtuHeader& header_;
  VtuData data_;
};

}  // namespace driftmesh
