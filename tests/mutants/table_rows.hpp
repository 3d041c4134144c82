#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "driftmesh/point.hpp"
#include "mutants/fields.hpp"

// Files of numbers in rows, as Triangle's are: a second reader of their lines. All functions throw Undeclared.

namespace driftmesh::mutants {

/// One line with fields. Whoever takes fewer than there are leaves zeros only.
class Row {
 public:
  explicit Row(std::vector<std::string_view> fields) : fields_(std::move(fields)) {}

  [[nodiscard]] bool has_more() const { return next_ < fields_.size(); }
  std::int64_t integer(std::int64_t low = std::numeric_limits<std::int32_t>::min(),
                       std::int64_t high = std::numeric_limits<std::int32_t>::max()) {
    const std::optional<std::int64_t> value = whole_number(take());
    if (!value || *value < low || *value > high) throw Undeclared("no whole number, or one out of range");
    return *value;
  }
  std::int32_t int32() { return static_cast<std::int32_t>(integer()); }
  std::size_t count() { return static_cast<std::size_t>(integer(0)); }
  bool flag() { return has_more() && integer(0, 1) == 1; }
  double real() {
    const std::optional<double> value = real_number(take());
    if (!value || !std::isfinite(*value)) throw Undeclared("no finite number");
    return *value;
  }
  /// Coordinates below 2^-120 are rounded to multiples of 2^-172.
  double coordinate() {
    const double value = real();
    return std::fabs(value) < 0x1p-120 ? std::ldexp(std::nearbyint(std::ldexp(value, 172)), -172) : value;
  }
  Point point() {
    const double x = coordinate();
    return {x, coordinate()};
  }
  void end() {
    while (has_more())
      if (take() != "0") throw Undeclared("a line has more fields than its header says");
  }

 private:
  std::string_view take() {
    if (!has_more()) throw Undeclared("a field is missing");
    return fields_[next_++];
  }
  std::vector<std::string_view> fields_;
  std::size_t next_ = 0;
};

/// The lines with fields, without comments.
class Table {
 public:
  explicit Table(std::string_view text) {
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    while (!text.empty()) {
      const std::string_view line = text.substr(0, text.find('\n'));
      text.remove_prefix(std::min(line.size() + 1, text.size()));
      add(line.substr(0, line.find('#')));
    }
  }
  [[nodiscard]] bool has_more() const { return next_ < rows_.size(); }
  Row row() {
    if (!has_more()) throw Undeclared("a line is missing");
    return Row(rows_[next_++]);
  }
  /// The next lines, each read to its end.
  template <class Read>
  void rows(std::size_t count, const Read& read) {
    if (count > rows_.size() - next_) throw Undeclared("there are fewer lines than announced");
    for (std::size_t i = 0; i < count; ++i) {
      Row r = row();
      read(r, static_cast<std::int64_t>(i));
      r.end();
    }
  }
  void end() const {
    if (has_more()) throw Undeclared("there are more lines than announced");
  }

 private:
  void add(std::string_view line) {
    constexpr std::string_view kBetweenWords = " \t\r\v\f";
    std::vector<std::string_view> fields;
    for (std::size_t begin = 0; (begin = line.find_first_not_of(kBetweenWords, begin)) != std::string_view::npos;) {
      const std::size_t end = std::min(line.find_first_of(kBetweenWords, begin), line.size());
      fields.push_back(line.substr(begin, end - begin));
      begin = end;
    }
    if (!fields.empty()) rows_.push_back(std::move(fields));
  }
  std::vector<std::vector<std::string_view>> rows_;
  std::size_t next_ = 0;
};

/// Rows of a mesh are numbered from 0 or 1.
class RowNumbers {
 public:
  void take(Row& row, std::int64_t index) {
    const std::int64_t number = row.integer();
    if (index == 0) first_ = number;
    if ((first_ != 0 && first_ != 1) || number != first_ + index) throw Undeclared("lines are not numbered in order");
  }
  [[nodiscard]] std::int64_t first() const { return first_; }

 private:
  std::int64_t first_ = 1;
};

}  // namespace driftmesh::mutants
