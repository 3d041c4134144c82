#pragma once

#include "driftmesh/load_snapshot.hpp"

namespace driftmesh::balancer {

/// The owners after overloaded ranks (with more than their share of all work in proportion to speed, plus `tolerance`)
/// have given up subdomains, those first that leave most easily, and these have been reassigned. Neighbors go together
/// to a rank that has room for them, next to their other neighbors if possible, so that few borders lie between ranks;
/// or, where that would end later by one and a half times the tolerance, each goes to the rank that would finish it
/// first, largest first. (Longest processing time first, Graham 1969, for machines of different speeds, starting from
/// the current distribution.) Never finishes later than before: returns the given snapshot if this does not help.
[[nodiscard]] LoadSnapshot deal_surplus(const LoadSnapshot& snapshot, double tolerance);

}  // namespace driftmesh::balancer
