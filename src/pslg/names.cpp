#include "pslg/names.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "base/from_chars.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh {
namespace {

constexpr std::size_t kLongest = 120;  // Gmsh keeps 127

/// The number of bytes of the character that begins a text; 0: none of UTF-8 (RFC 3629) does.
std::size_t length_of_character(std::string_view text) {
  const auto at = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
  const unsigned first = at(0);
  const std::size_t length = first < 0x80   ? 1
                             : first < 0xC2 ? 0
                             : first < 0xE0 ? 2
                             : first < 0xF0 ? 3
                             : first < 0xF5 ? 4
                                            : 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((at(i) & 0xC0U) != 0x80U) return 0;
  const bool is_overlong = (first == 0xE0 && at(1) < 0xA0) || (first == 0xF0 && at(1) < 0x90);
  const bool is_no_character = (first == 0xED && at(1) >= 0xA0) || (first == 0xF4 && at(1) >= 0x90);
  return is_overlong || is_no_character ? 0 : length;
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = length_of_character(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

bool is_control(char c) {
  return static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
}

template <class Value>
bool is_taken(const std::map<Value, std::string>& names, const std::string& name) {
  return std::ranges::any_of(names, [&](const auto& entry) { return entry.second == name; });
}

template <class Number>
std::optional<Number> number_from(std::string_view text) {
  Number value{};
  const auto [end, error] = from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

template <class Value>
void add_name(Names& names, std::map<Value, std::string>& to, Value value, std::string&& name) {
  if (!fault_of_name(name).empty() || is_taken(names.markers, name) || is_taken(names.regions, name)) return;
  to.try_emplace(value, std::move(name));
}

}  // namespace

std::string fault_of_name(std::string_view name) {
  if (name.empty()) return "is empty";
  if (name.size() > kLongest) return "has more than " + std::to_string(kLongest) + " bytes";
  if (!is_utf8(name)) return "is not UTF-8";
  if (std::ranges::any_of(name, is_control)) return "has a control character";
  if (name.find('"') != std::string_view::npos) return "has a quote";
  if (name.front() == ' ' || name.back() == ' ') return "begins or ends with a blank";
  if (name == "domain" || name.starts_with("marker ") || name.starts_with("region "))
    return "is one that .msh has for numbers";
  return "";
}

void check_names(const Names& names, const std::string& file) {
  std::set<std::string> used;
  const auto check = [&](const auto& map) {
    for (const auto& [value, name] : map) {
      if (const std::string fault = fault_of_name(name); !fault.empty())
        throw InputError({file, 0}, "the name '" + name + "' " + fault, "choose another");
      if (!used.insert(name).second)
        throw InputError({file, 0}, "the name '" + name + "' is given twice",
                         "give each marker and each region a name of its own");
    }
  };
  check(names.markers);
  check(names.regions);
  for (const auto& [region, name] : names.regions)
    if (!std::isfinite(region)) throw InputError({file, 0}, "the name '" + name + "' is for no number", "correct it");
}

std::optional<std::int32_t> marker_from(std::string_view text) {
  return number_from<std::int32_t>(text);
}

std::optional<double> region_from(std::string_view text) {
  const auto region = number_from<double>(text);
  return region && std::isfinite(*region) ? region : std::nullopt;
}

void add_marker_name(Names& names, std::int32_t marker, std::string name) {
  add_name(names, names.markers, marker, std::move(name));
}

void add_region_name(Names& names, double region, std::string name) {
  if (std::isfinite(region)) add_name(names, names.regions, region, std::move(name));
}

}  // namespace driftmesh
