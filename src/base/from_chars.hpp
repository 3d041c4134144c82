#pragma once

#include <charconv>
#include <type_traits>
#include <version>

namespace driftmesh {

/// std::from_chars of a number with a fraction, by std::strtod.
[[nodiscard]] std::from_chars_result from_chars_by_strtod(const char* begin, const char* end, double& value);

/// std::from_chars, also where the standard library lacks it for numbers with fractions.
template <class Number>
[[nodiscard]] std::from_chars_result from_chars(const char* begin, const char* end, Number& value) {
#ifndef __cpp_lib_to_chars
  if constexpr (std::is_floating_point_v<Number>) {
    double wide = 0;
    const std::from_chars_result result = from_chars_by_strtod(begin, end, wide);
    if (result.ec == std::errc()) value = static_cast<Number>(wide);
    return result;
  } else
#endif
  {
    return std::from_chars(begin, end, value);
  }
}

}  // namespace driftmesh
