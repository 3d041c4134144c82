#include "io/boundary_types.hpp"

#include <algorithm>
#include <charconv>

namespace driftmesh {
namespace {

constexpr std::string_view kOpenName = "open";
constexpr std::string_view kTypePrefix = "ibtype ";

/// Calls visit(a, b) for each edge of a weir: those of both sides, and those that may be between them at the ends.
template <class Visit>
void for_each_weir_edge(const Mesh::Weir& weir, const Visit& visit) {
  for (const std::vector<std::int32_t>* side : {&weir.points, &weir.across})
    for (std::size_t i = 1; i < side->size(); ++i) visit((*side)[i - 1], (*side)[i]);
  if (weir.across.empty()) return;
  visit(weir.points.front(), weir.across.front());
  visit(weir.points.back(), weir.across.back());
}

/// Each marker is a part of its own.
std::map<std::int32_t, EdgeType> types_of_markers(const Names& names) {
  std::map<std::int32_t, EdgeType> types;
  for (const auto& [marker, name] : names.markers)
    if (const auto type = type_named(name)) types[marker] = {*type, marker};
  return types;
}

/// Markers without a type are mainland, whichever they are.
EdgeType type_by_marker(const Mesh& mesh, std::int32_t edge, const std::map<std::int32_t, EdgeType>& types) {
  const auto known = types.find(edge < 0 ? 0 : mesh.edges[static_cast<std::size_t>(edge)].marker);
  return known == types.end() ? EdgeType{} : known->second;
}

}  // namespace

std::optional<WeirColumns> weir_columns(std::int32_t type) {
  switch (type) {
    case 3:
    case 13:
    case 23:
      return WeirColumns{false, 2};
    case 4:
    case 24:
    case 64:
      return WeirColumns{true, 3};
    case 5:
    case 25:
      return WeirColumns{true, 6};
    default:
      return std::nullopt;
  }
}

std::string name_of_type(std::int32_t type) {
  return type == kOpenType ? std::string(kOpenName) : std::string(kTypePrefix) + std::to_string(type);
}

std::optional<std::int32_t> type_named(std::string_view name) {
  if (name == kOpenName || name.starts_with(std::string(kOpenName) + ' ')) return kOpenType;
  if (!name.starts_with(kTypePrefix)) return std::nullopt;
  name.remove_prefix(kTypePrefix.size());
  std::int32_t type = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), type);
  const bool is_whole = end == name.data() + name.size() || *end == ' ';
  return error == std::errc() && is_whole && type >= 0 && type <= kLargestType ? std::optional(type) : std::nullopt;
}

EdgeTypes::EdgeTypes(const Mesh& mesh, std::span<const std::int32_t> open, bool with_weirs)
    : mesh_(mesh), by_marker_(types_of_markers(mesh.names)) {
  std::erase_if(by_marker_, [&](const auto& known) {
    return (known.second.type == kOpenType && !open.empty()) || weir_columns(known.second.type);
  });
  for (const std::int32_t marker : open) by_marker_[marker] = {kOpenType, 0};
  if (!with_weirs) return;
  for (const Mesh::Weir& weir : mesh.weirs)
    for_each_weir_edge(weir, [&](std::int32_t a, std::int32_t b) {
      weirs_.push_back({std::min(a, b), std::max(a, b)});
    });
  std::ranges::sort(weirs_);
}

EdgeType EdgeTypes::of(std::int32_t from, std::int32_t to, std::int32_t edge) const {
  if (std::ranges::binary_search(weirs_, std::array{std::min(from, to), std::max(from, to)})) return {kWeirType, 0};
  return type_by_marker(mesh_, edge, by_marker_);
}

std::map<std::int32_t, std::size_t> count_types(const Mesh& mesh) {
  const std::map<std::int32_t, EdgeType> by_marker = types_of_markers(mesh.names);
  std::map<std::int32_t, std::size_t> counts;
  if (!by_marker.empty()) {
    const auto type_of = [&](std::int32_t, std::int32_t, std::int32_t edge) {
      return type_by_marker(mesh, edge, by_marker);
    };
    for (const BoundaryString& string : boundary_of(mesh, type_of).strings)
      if (string.type != kMainlandType && string.type != kIslandType) ++counts[string.type];
  }
  if (!mesh.weirs.empty()) std::erase_if(counts, [](const auto& count) { return weir_columns(count.first); });
  for (const Mesh::Weir& weir : mesh.weirs) ++counts[weir.type];
  return counts;
}

std::string list_of_types(const std::map<std::int32_t, std::size_t>& counts) {
  std::string list;
  for (const auto& [type, count] : counts)
    list += (list.empty() ? "" : ", ") + name_of_type(type) + " (" + std::to_string(count) +
            (count == 1 ? " string)" : " strings)");
  return list;
}

}  // namespace driftmesh
