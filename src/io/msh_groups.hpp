#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace driftmesh {

/// The name of the one surface group of a mesh without regions.
inline constexpr std::string_view kDomainName = "domain";
// The names of the views with the subdomain and the rank in which each triangle was made.
inline constexpr std::string_view kSubdomainView = "subdomain";
inline constexpr std::string_view kRankView = "rank";

// The names of physical groups hold the exact value, which a tag, a positive integer, cannot.
[[nodiscard]] std::string marker_group_name(std::int32_t marker);
[[nodiscard]] std::string region_group_name(double region);
[[nodiscard]] std::optional<std::int32_t> marker_of_group_name(std::string_view name);
[[nodiscard]] std::optional<double> region_of_group_name(std::string_view name);

/// The tag of the group of value 0, the same in every file: few markers are that large, and still a solver may have an
/// array by tag.
inline constexpr std::int32_t kTagOfZero = 1'000'000;

/// Tags for groups of the given distinct values, whatever their order: the value itself where that is an integer from 1
/// to the largest int32, and kTagOfZero for 0. Negative and fractional values, and kTagOfZero itself beside a 0, get
/// the unused tags above kTagOfZero, in ascending order.
[[nodiscard]] std::vector<std::int32_t> group_tags(const std::vector<double>& values);

/// The same by value. Solvers that read other formats want such tags, too.
[[nodiscard]] std::map<double, std::int32_t> tags_of_values(const std::set<double>& distinct);

}  // namespace driftmesh
