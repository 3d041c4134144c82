#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "decompose/decomposition.hpp"
#include "driftmesh/ids.hpp"

namespace driftmesh::adapt {

// How many subdomains a mesh should have as lengths change, decided by the triangles that they ask of each, alike on
// all ranks. `shares`: the number of subdomains of which one has the mean.

/// A subdomain is divided if lengths ask for more than this many times the mean of it, unless it is small.
inline constexpr double kHeavy = 4;
inline constexpr double kSmall = 400;  // triangles
/// One of which they ask for less than this share of the mean is joined with others.
inline constexpr double kLight = 0.25;

/// Those that are to be divided, ascending, each with the number of parts that it should have.
[[nodiscard]] std::vector<std::pair<SubdomainId, std::int32_t>> heavy_ones(const IdVector<SubdomainId, double>& asked,
                                                                           std::int32_t shares);

/// For each subdomain the lowest number of those that it is to be joined with across separators, its own if with none:
/// groups, each with a light one, that together have no more than the mean. No groups at all unless enough would go to
/// be worth a change of numbers; empty then.
[[nodiscard]] IdVector<SubdomainId, SubdomainId> light_groups(const Decomposition& decomposition,
                                                              const IdVector<SubdomainId, double>& asked,
                                                              std::int32_t shares);

}  // namespace driftmesh::adapt
