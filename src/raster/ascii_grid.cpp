#include "raster/ascii_grid.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/from_chars.hpp"
#include "base/letter_case.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh {
namespace {

constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

std::string quoted(std::string_view word) {
  constexpr std::size_t kMost = 40;
  std::string text("'");
  text += word.substr(0, kMost);
  text += word.size() > kMost ? "...'" : "'";
  return text;
}

}  // namespace

struct AsciiGrid::Header {
  std::optional<double> ncols, nrows, xllcorner, xllcenter, yllcorner, yllcenter, cellsize, dx, dy, nodata_value;

  /// Null: there is no such entry.
  std::optional<double>* named(const std::string& name) {
    const std::pair<const char*, std::optional<double>*> known[]{{"ncols", &ncols},
                                                                 {"nrows", &nrows},
                                                                 {"xllcorner", &xllcorner},
                                                                 {"xllcenter", &xllcenter},
                                                                 {"yllcorner", &yllcorner},
                                                                 {"yllcenter", &yllcenter},
                                                                 {"cellsize", &cellsize},
                                                                 {"dx", &dx},
                                                                 {"dy", &dy},
                                                                 {"nodata_value", &nodata_value}};
    const auto* const found = std::ranges::find(known, name, [](const auto& entry) { return entry.first; });
    return found == std::end(known) ? nullptr : found->second;
  }
};

AsciiGrid::AsciiGrid(std::string file, std::string_view text) : file_(std::move(file)), rest_(text) {
  read_header();
}

void AsciiGrid::fail(const std::string& what, const std::string& next) const {
  throw InputError({file_, word_line_}, what, next);
}

/// Empty at the end of the file.
std::string_view AsciiGrid::next_word() {
  std::size_t begin = 0;
  for (; begin < rest_.size() && is_blank(rest_[begin]); ++begin) line_ += rest_[begin] == '\n' ? 1 : 0;
  std::size_t end = begin;
  while (end < rest_.size() && !is_blank(rest_[end])) ++end;
  const std::string_view word = rest_.substr(begin, end - begin);
  rest_.remove_prefix(end);
  word_line_ = line_;
  return word;
}

double AsciiGrid::number(std::string_view word, const char* what) const {
  double value = 0;
  const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
  const auto [end, error] = from_chars(digits.data(), digits.data() + digits.size(), value);
  if (word.empty()) fail("the file ends where " + std::string(what) + " is expected", "it was not written completely");
  if (error != std::errc{} || end != digits.data() + digits.size())
    fail(quoted(word) + " is not " + what, "numbers have a point, and blanks between them");
  return value;
}

void AsciiGrid::read_header() {
  Header header;
  while (true) {
    const std::string_view before = rest_;
    const std::size_t line = line_;
    const std::string_view name = next_word();
    if (name.empty() || std::isalpha(static_cast<unsigned char>(name.front())) == 0 || lower_case(name) == "nan") {
      rest_ = before;
      line_ = line;
      break;
    }
    std::optional<double>* const entry = header.named(lower_case(name));
    if (entry == nullptr)
      fail(quoted(name) + " is not an entry of the header", "an ESRI ASCII grid begins with ncols and nrows");
    if (*entry) fail("the header has " + quoted(name) + " twice", "remove one of them");
    *entry = number(next_word(), "a number");
  }
  set_frame(header);
}

void AsciiGrid::set_frame(const Header& header) {
  const auto require = [&](bool sound, const char* what) {
    if (!sound) fail(what, "an ESRI ASCII grid begins with ncols, nrows, xllcorner, yllcorner and cellsize");
  };
  const auto is_count = [](const std::optional<double>& n) {
    return n && *n >= 1 && *n <= 1e9 && *n == std::floor(*n);
  };
  require(is_count(header.ncols) && is_count(header.nrows), "the header has no whole number of columns and rows");
  require(header.xllcorner.has_value() != header.xllcenter.has_value() &&
              header.yllcorner.has_value() != header.yllcenter.has_value(),
          "the header does not say where the lower left value is, or twice");
  require(header.cellsize.has_value() != (header.dx && header.dy), "the header does not have one size of cells");
  frame_.columns = static_cast<std::int64_t>(*header.ncols);
  frame_.rows = static_cast<std::int64_t>(*header.nrows);
  frame_.dx = header.cellsize ? *header.cellsize : *header.dx;
  frame_.dy = header.cellsize ? *header.cellsize : *header.dy;
  require(frame_.dx > 0 && frame_.dy > 0 && std::isfinite(frame_.dx) && std::isfinite(frame_.dy),
          "the size of cells is not positive");
  frame_.first = {header.xllcenter ? *header.xllcenter : *header.xllcorner + frame_.dx / 2,
                  header.yllcenter ? *header.yllcenter : *header.yllcorner + frame_.dy / 2};
  require(std::isfinite(frame_.first.x) && std::isfinite(frame_.first.y),
          "the place of the lower left value is not finite");
  none_ = header.nodata_value.value_or(none_);
  next_row_ = frame_.rows - 1;
  // Each takes a character and a blank. Products of two counts below 1e9 fit.
  if (frame_.columns * frame_.rows > static_cast<std::int64_t>(rest_.size() / 2 + 1))
    fail("the file is too short for the " + std::to_string(frame_.columns) + " columns and " +
             std::to_string(frame_.rows) + " rows that it announces",
         "it was not written completely");
}

float AsciiGrid::value_of(std::string_view word) const {
  const double value = number(word, "a value");
  if (value == none_ || std::isnan(value)) return kNoValue;
  const auto kept = static_cast<float>(value);
  if (!std::isfinite(kept))
    fail(quoted(word) + " is beyond single precision", "correct it, or declare it the NODATA_value");
  return kept;
}

void AsciiGrid::skip_to(std::int64_t j) {
  for (; next_row_ > j; --next_row_)
    for (std::int64_t i = 0; i < frame_.columns; ++i) static_cast<void>(value_of(next_word()));
}

void AsciiGrid::read(std::int64_t j, std::int64_t first, std::span<float> values) {
  skip_to(j);
  const std::int64_t behind = first + static_cast<std::int64_t>(values.size());
  for (std::int64_t i = 0; i < frame_.columns; ++i) {
    const float value = value_of(next_word());
    if (i >= first && i < behind) values[static_cast<std::size_t>(i - first)] = value;
  }
  --next_row_;
}

void AsciiGrid::finish() {
  skip_to(-1);
  if (const std::string_view word = next_word(); !word.empty())
    fail(quoted(word) + " follows the last of the values that the header announces", "correct ncols or nrows");
}

}  // namespace driftmesh
