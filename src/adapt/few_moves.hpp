#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "adapt/loads.hpp"
#include "decompose/decomposition.hpp"
#include "driftmesh/ids.hpp"

namespace driftmesh::adapt {

/// Holders that differ from `holders` in little work, such that no rank takes more than `even` times what it would take
/// if all took the same, as far as that goes: parts go one by one from the slowest rank to the rank of a neighbor that
/// has room for them. Where none at the border of a rank fits, others go, and where no rank beside it has
/// room, to the emptiest of all, so that ranks may have islands. `neighbors`:
/// pairs of parts that have a border.
[[nodiscard]] IdVector<SubdomainId, Rank> few_moves(const Loads& loads, const IdVector<SubdomainId, Rank>& holders,
                                                    const std::vector<std::pair<SubdomainId, SubdomainId>>& neighbors,
                                                    double even);

/// The slowest rank may take so many times what it would take if all took the same.
inline constexpr double kEven = 1.05;

/// `holders` while they are even; or else few moves from them, where that is enough; or else few moves from what
/// `anew` chooses.
[[nodiscard]] IdVector<SubdomainId, Rank> even_holders(const Loads& loads, const IdVector<SubdomainId, Rank>& holders,
                                                       const Decomposition& decomposition,
                                                       const std::function<IdVector<SubdomainId, Rank>()>& anew);

}  // namespace driftmesh::adapt
