#pragma once

#include <optional>
#include <string_view>
#include <system_error>

#include "base/from_chars.hpp"

namespace driftmesh {

/// The number that a word is, maybe with a plus sign; none if it is something else.
template <class Number>
[[nodiscard]] std::optional<Number> number_of(std::string_view word) {
  const char* const begin = word.data() + (word.starts_with('+') ? 1 : 0);
  const char* const end = word.data() + word.size();
  Number value{};
  const auto [stop, error] = from_chars(begin, end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

}  // namespace driftmesh
