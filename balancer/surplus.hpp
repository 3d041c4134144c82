#pragma once

#include "driftmesh/load_snapshot.hpp"

namespace driftmesh::balancer {

/// The owners after every rank with more than its share (of all work, in proportion to its speed, and `tolerance` more)
/// has given up subdomains until it has not, those first that leave most easily, and these have been dealt anew:
/// largest first, each to the rank that would finish it first. (Longest processing time first, Graham 1969, for
/// machines of different speeds, from where things are.) Never finishes later than before: the snapshot as it was, if
/// dealing does not help.
[[nodiscard]] LoadSnapshot deal_surplus(const LoadSnapshot& snapshot, double tolerance);

}  // namespace driftmesh::balancer
