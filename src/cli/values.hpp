#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "cli/command.hpp"

namespace driftmesh::cli {

struct Range {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool above = false;  ///< greater than `least`, not equal
};
constexpr Range kPositive{.least = 0, .above = true};

/// Parses a text that consists of a number. Throws UsageError if it does not, or if the number is not finite or out of
/// range.
[[nodiscard]] double read_number(const std::string& text, const Range& range);
/// Likewise, for std::int64_t and std::uint64_t.
template <std::integral Number>
[[nodiscard]] Number read_integer(const std::string& text, const Range& range);

// Functions for Option::take. Each stores the value in a variable that must outlive the command.

using Take = std::function<void(const std::string&)>;

template <std::floating_point Number>
[[nodiscard]] Take into(Number& to, const Range& range = {}) {
  return [&to, range](const std::string& text) { to = read_number(text, range); };
}
template <std::integral Number>
[[nodiscard]] Take into(Number& to, Range range = {}) {
  range.least = std::max(range.least, static_cast<double>(std::numeric_limits<Number>::min()));
  range.most = std::min(range.most, static_cast<double>(std::numeric_limits<Number>::max()));
  using Widest = std::conditional_t<std::is_signed_v<Number>, std::int64_t, std::uint64_t>;
  return [&to, range](const std::string& text) { to = static_cast<Number>(read_integer<Widest>(text, range)); };
}
/// A text that is not empty.
[[nodiscard]] Take into(std::string& to);
/// Appends a value.
[[nodiscard]] inline Take into(std::vector<std::string>& to) {
  return [&to](const std::string& text) { to.push_back(text); };
}
/// A value that may be missing.
template <class Number>
[[nodiscard]] Take into(std::optional<Number>& to, const Range& range = {}) {
  return [&to, range](const std::string& text) { into(to.emplace(), range)(text); };
}
[[nodiscard]] inline Take into(std::optional<std::string>& to) {
  return [&to](const std::string& text) { to = text; };
}
/// What lies between commas; "" is one item.
[[nodiscard]] std::vector<std::string> separated(const std::string& text);
/// Numbers separated by commas, in place of earlier ones.
template <class Number>
requires std::integral<Number> || std::floating_point<Number>
[[nodiscard]] Take into(std::vector<Number>& to, const Range& range = {}) {
  return [&to, range](const std::string& text) {
    to.clear();
    for (const std::string& item : separated(text)) into(to.emplace_back(), range)(item);
  };
}
/// A flag.
[[nodiscard]] inline Take into(bool& to) {
  return [&to](const std::string&) { to = true; };
}

}  // namespace driftmesh::cli
