#pragma once

#include <algorithm>
#include <initializer_list>
#include <string>

#include "driftmesh/error.hpp"

namespace driftmesh::testing {

/// What the E says that `run` throws; "no error" if it throws none.
template <class E = Error, class Run>
[[nodiscard]] std::string error_text(const Run& run) {
  try {
    run();
  } catch (const E& error) {
    return error.what();
  }
  return "no error";
}

[[nodiscard]] inline bool mentions(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}
[[nodiscard]] inline bool mentions(const std::string& text, std::initializer_list<const char*> parts) {
  return std::ranges::all_of(parts, [&](const char* part) { return mentions(text, std::string(part)); });
}

}  // namespace driftmesh::testing
