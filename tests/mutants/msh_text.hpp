#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "mutants/fields.hpp"

namespace driftmesh::mutants {

/// The values of a .msh in either form, one after the other, for a second reader. Notes their fields; throws
/// Undeclared.
class MshText {
 public:
  MshText(std::string_view bytes, Fields& fields) : bytes_(bytes), fields_(fields) {}

  bool is_binary = false;  ///< what numbers() reads, which is not all of a binary file

  [[nodiscard]] bool at_end() const { return at_ == bytes_.size(); }
  void skip_blanks() { at_ = std::min(bytes_.find_first_not_of(kBlanks, at_), bytes_.size()); }
  std::string_view line() {
    const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
    std::string_view line = bytes_.substr(at_, end - at_);
    note({at_, line.size(), Field::Kind::kText, true});
    at_ = std::min(end + 1, bytes_.size());
    line.remove_suffix(line.size() - (line.find_last_not_of(" \t\r") + 1));
    return line;
  }

  std::int32_t integer() { return is_binary ? bytes<std::int32_t>(Field::Kind::kInt32) : text_integer(); }
  std::int32_t text_integer() {
    const std::optional<std::int64_t> value = whole_number(word());
    if (!value || !std::in_range<std::int32_t>(*value)) throw Undeclared("no whole number");
    return static_cast<std::int32_t>(*value);
  }
  std::uint64_t size() { return is_binary ? bytes<std::uint64_t>(Field::Kind::kInt64) : text_size(); }
  std::uint64_t text_size() {
    const std::string_view text = word();
    // Binary files may hold sizes that no file has.
    if (text.find_first_not_of("0123456789") != std::string_view::npos || text.size() > 20) throw Undeclared("no size");
    const auto value = static_cast<long double>(std::strtold(std::string(text).c_str(), nullptr));
    if (value > static_cast<long double>(std::numeric_limits<std::uint64_t>::max())) throw Undeclared("no size");
    return std::strtoull(std::string(text).c_str(), nullptr, 10);
  }
  double real() { return is_binary ? bytes<double>(Field::Kind::kFloat64) : text_real(); }
  double text_real() {
    const std::optional<double> value = real_number(word());
    if (!value) throw Undeclared("no number");
    return *value;
  }
  /// A count of things that each take a byte at least.
  std::uint64_t count() { return checked(size()); }
  std::uint64_t text_count() { return checked(text_size()); }

  /// Ends a line, where the file is text.
  void end_record() {
    if (!fields_.empty()) fields_.back().ends_record = true;
  }

 private:
  static constexpr std::string_view kBlanks = " \t\r\n";

  [[nodiscard]] std::uint64_t checked(std::uint64_t count) const {
    if (count > bytes_.size() - at_) throw Undeclared("more things than there is room for");
    return count;
  }
  void note(const Field& field) { fields_.push_back(field); }
  std::string_view word() {
    skip_blanks();
    const std::size_t end = std::min(bytes_.find_first_of(kBlanks, at_), bytes_.size());
    if (end == at_) throw Undeclared("the file ends early");
    note({at_, end - at_});
    return bytes_.substr(std::exchange(at_, end), end - fields_.back().begin);
  }
  template <class T>
  T bytes(Field::Kind kind) {
    if (bytes_.size() - at_ < sizeof(T)) throw Undeclared("the file ends early");
    T value;
    std::memcpy(&value, bytes_.data() + at_, sizeof(T));
    note({at_, sizeof(T), kind});
    at_ += sizeof(T);
    return value;
  }

  std::string_view bytes_;
  Fields& fields_;
  std::size_t at_ = 0;
};

}  // namespace driftmesh::mutants
