#include "io/msh_groups.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <compare>
#include <limits>
#include <unordered_set>

#include "base/from_chars.hpp"

namespace driftmesh {
namespace {

constexpr std::string_view kMarkerPrefix = "marker ";
constexpr std::string_view kRegionPrefix = "region ";

template <class Number>
std::string name_of(std::string_view prefix, Number value) {
  char digits[32];
  const char* const end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  return std::string(prefix).append(digits, static_cast<std::size_t>(end - digits));
}

template <class Number>
std::optional<Number> value_of(std::string_view prefix, std::string_view name) {
  if (!name.starts_with(prefix)) return std::nullopt;
  name.remove_prefix(prefix.size());
  Number value{};
  const auto [end, error] = from_chars(name.data(), name.data() + name.size(), value);
  if (error != std::errc() || end != name.data() + name.size()) return std::nullopt;
  return value;
}

std::int32_t own_tag(double value) {
  const bool is_tag = value >= 1 && value <= std::numeric_limits<std::int32_t>::max() && value == std::floor(value);
  return is_tag ? static_cast<std::int32_t>(value) : 0;
}

}  // namespace

std::string marker_group_name(std::int32_t marker) {
  return name_of(kMarkerPrefix, marker);
}

std::string region_group_name(double region) {
  return name_of(kRegionPrefix, region);
}

std::optional<std::int32_t> marker_of_group_name(std::string_view name) {
  return value_of<std::int32_t>(kMarkerPrefix, name);
}

std::optional<double> region_of_group_name(std::string_view name) {
  return value_of<double>(kRegionPrefix, name);
}

std::vector<std::int32_t> group_tags(const std::vector<double>& values) {
  const auto is_zero = [](double value) { return value == 0 && !std::signbit(value); };
  const bool has_zero = std::any_of(values.begin(), values.end(), is_zero);
  std::vector<std::int32_t> tags(values.size(), 0);
  std::unordered_set<std::int32_t> used;
  std::vector<std::size_t> others;
  for (std::size_t i = 0; i < values.size(); ++i) {
    tags[i] = is_zero(values[i]) ? kTagOfZero : own_tag(values[i]);
    if (tags[i] == 0 || (tags[i] == kTagOfZero && has_zero && !is_zero(values[i])))
      others.push_back(i);
    else
      used.insert(tags[i]);
  }
  std::sort(others.begin(), others.end(),
            [&](std::size_t i, std::size_t j) { return std::strong_order(values[i], values[j]) < 0; });
  std::int32_t next = kTagOfZero + 1;
  for (const std::size_t i : others) {
    while (used.contains(next)) ++next;
    tags[i] = next++;
  }
  return tags;
}

std::map<double, std::int32_t> tags_of_values(const std::set<double>& distinct) {
  const std::vector<double> values(distinct.begin(), distinct.end());
  const std::vector<std::int32_t> tags = group_tags(values);
  std::map<double, std::int32_t> result;
  for (std::size_t i = 0; i < values.size(); ++i) result[values[i]] = tags[i];
  return result;
}

}  // namespace driftmesh
