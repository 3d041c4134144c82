#pragma once

#include "driftmesh/load_snapshot.hpp"

namespace driftmesh::balancer {

/// The owners after overloaded ranks (with more than their share of all work in proportion to speed, plus `tolerance`)
/// have given up subdomains, those first that leave most easily, and these have been reassigned. Neighbors go together
/// to a rank that has room for them, next to their other neighbors if possible, so that few borders lie between ranks.
/// There is room for what a rank finishes by a limit: a half, one or one and a half times the tolerance (of the ideal
/// time) after all would finish if each subdomain went to the rank that would finish it first, largest first; if not
/// even the last of these limits can be kept, they go so. (Longest processing time first, Graham 1969, for machines of
/// different speeds, starting from the current distribution.) No rank gets what it has no memory for; what fits nowhere
/// stays. Never finishes later than before: returns the given snapshot if this does not help.
[[nodiscard]] LoadSnapshot deal_surplus(const LoadSnapshot& snapshot, double tolerance);

}  // namespace driftmesh::balancer
