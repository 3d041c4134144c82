#pragma once

#include <span>
#include <vector>

#include "driftmesh/load_snapshot.hpp"

namespace driftmesh::balancer {

/// Which rank takes which part, given the part of each listed subdomain (parts are made for ranks in order: part r has
/// the size of rank r): an exchange of parts between ranks, so that much work stays where it is, as long as nobody
/// finishes later than part r on rank r would let the last rank finish, `tolerance` aside. Returns the owner of each
/// subdomain.
[[nodiscard]] std::vector<Rank> remap_parts(const LoadSnapshot& snapshot, std::span<const Part> parts,
                                            double tolerance);

}  // namespace driftmesh::balancer
