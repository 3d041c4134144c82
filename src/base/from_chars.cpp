#include "base/from_chars.hpp"

#include <algorithm>
#include <clocale>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <string>
#include <string_view>

namespace driftmesh {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// The end of the longest number that std::from_chars takes; the beginning if there is none.
const char* end_of_number(const char* const begin, const char* const end) {
  const char* at = begin + (begin != end && *begin == '-' ? 1 : 0);
  const auto is_next = [&](std::string_view word) {
    return word.size() <= static_cast<std::size_t>(end - at) &&
           std::equal(word.begin(), word.end(), at, [](char letter, char c) { return letter == (c | ' '); });
  };
  for (const std::string_view word : {"infinity", "inf", "nan"})
    if (is_next(word)) return at + word.size();
  const char* const whole = at;
  while (at != end && is_digit(*at)) ++at;
  auto digits = at - whole;
  if (at != end && *at == '.') {
    const char* const fraction = ++at;
    while (at != end && is_digit(*at)) ++at;
    digits += at - fraction;
  }
  if (digits == 0) return begin;
  if (at != end && (*at | ' ') == 'e') {
    const char* power = at + 1;
    if (power != end && (*power == '-' || *power == '+')) ++power;
    if (power != end && is_digit(*power)) {
      while (power != end && is_digit(*power)) ++power;
      at = power;
    }
  }
  return at;
}

}  // namespace

std::from_chars_result from_chars_by_strtod(const char* begin, const char* end, double& value) {
  const char* const stop = end_of_number(begin, end);
  if (stop == begin) return {begin, std::errc::invalid_argument};
  std::string text(begin, stop);
  std::replace(text.begin(), text.end(), '.', *std::localeconv()->decimal_point);  // NOLINT(concurrency-mt-unsafe)
  const double number = std::strtod(text.c_str(), nullptr);
  const bool is_named = text.find_first_of("0123456789") == std::string::npos;
  const bool is_zero = text.find_first_of("123456789") >= text.find_first_of("eE");
  if (!is_named && (std::isinf(number) || (number == 0 && !is_zero))) return {stop, std::errc::result_out_of_range};
  value = number;
  return {stop, {}};
}

}  // namespace driftmesh
