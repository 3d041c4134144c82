#pragma once

#include "driftmesh/load_snapshot.hpp"

namespace driftmesh::balancer {

/// The owners after overloaded ranks (with more than their share of all work in proportion to speed, plus `tolerance`)
/// have given up subdomains, those first that leave most easily, and these have been reassigned: largest first, each to
/// the rank that would finish it first. (Longest processing time first, Graham 1969, for machines of different speeds,
/// starting from the current distribution.) Never finishes later than before: returns the given snapshot if this does
/// not help.
[[nodiscard]] LoadSnapshot deal_surplus(const LoadSnapshot& snapshot, double tolerance);

}  // namespace driftmesh::balancer
