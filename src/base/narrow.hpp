#pragma once

#include <string>
#include <type_traits>
#include <utility>

#include "driftmesh/error.hpp"

namespace driftmesh {

/// Converts an integer to a narrower type, or to a number that is an enumeration, or throws LimitError naming `what`
/// when the value does not fit.
template <class To, class From>
[[nodiscard]] constexpr To narrow(From value, const char* what) {
  if constexpr (std::is_enum_v<To>) {
    return To{narrow<std::underlying_type_t<To>>(value, what)};
  } else {
    if (!std::in_range<To>(value))
      throw LimitError(std::string(what) + ": " + std::to_string(value) + " does not fit the range of its type");
    return static_cast<To>(value);
  }
}

}  // namespace driftmesh
