#pragma once

#include <string>
#include <utility>

#include "driftmesh/error.hpp"

namespace driftmesh {

/// Converts an integer to a narrower type, or throws LimitError naming `what` when the value does not fit.
template <class To, class From>
[[nodiscard]] constexpr To narrow(From value, const char* what) {
  if (!std::in_range<To>(value))
    throw LimitError(std::string(what) + ": " + std::to_string(value) + " does not fit the range of its type");
  return static_cast<To>(value);
}

}  // namespace driftmesh
