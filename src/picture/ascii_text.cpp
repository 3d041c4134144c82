#include "picture/ascii_text.hpp"

#include <array>
#include <string_view>
#include <utility>

namespace driftmesh {
namespace {

using Spelled = std::pair<std::string_view, std::string_view>;

constexpr std::array<Spelled, 2> kSigns{{{"\u00b0", " deg"}, {"\u00b7", "*"}}};
constexpr std::array<Spelled, 11> kRaised{{{"\u2070", "0"},
                                           {"\u00b9", "1"},
                                           {"\u00b2", "2"},
                                           {"\u00b3", "3"},
                                           {"\u2074", "4"},
                                           {"\u2075", "5"},
                                           {"\u2076", "6"},
                                           {"\u2077", "7"},
                                           {"\u2078", "8"},
                                           {"\u2079", "9"},
                                           {"\u207b", "-"}}};

template <class Table>
const Spelled* begins_with(std::string_view text, const Table& table) {
  for (const Spelled& entry : table)
    if (text.starts_with(entry.first)) return &entry;
  return nullptr;
}

/// Bytes of the character that the text begins with, in UTF-8.
std::size_t length_of_first(std::string_view text) {
  std::size_t length = 1;
  while (length < text.size() && (static_cast<unsigned char>(text[length]) & 0xC0U) == 0x80U) ++length;
  return length;
}

}  // namespace

std::string ascii_text(const std::string& text) {
  std::string ascii;
  bool raised = false;
  for (std::string_view rest = text; !rest.empty();) {
    const Spelled* const power = begins_with(rest, kRaised);
    if (power != nullptr && !raised) ascii += '^';
    raised = power != nullptr;
    const std::size_t length = length_of_first(rest);
    if (const Spelled* const known = raised ? power : begins_with(rest, kSigns); known != nullptr)
      ascii += known->second;
    else
      ascii += length == 1 ? rest.front() : '?';
    rest.remove_prefix(length);
  }
  return ascii;
}

}  // namespace driftmesh
