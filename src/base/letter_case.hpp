#pragma once

#include <string>
#include <string_view>

namespace driftmesh {

// Only the letters of ASCII have a case here, whatever the locale is: std::tolower and std::toupper follow it, and a
// program that uses the library may have set it (Python's interpreter does). All other bytes stay as they are, so UTF-8
// stays valid.

[[nodiscard]] constexpr char lower_case(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

[[nodiscard]] constexpr char upper_case(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

[[nodiscard]] inline std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = lower_case(c);
  return result;
}

[[nodiscard]] inline std::string upper_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = upper_case(c);
  return result;
}

}  // namespace driftmesh
