#pragma once

#include <mpi.h>

#include <vector>

#include "adapt/generation.hpp"
#include "adapt/loads.hpp"
#include "decompose/decomposition.hpp"
#include "distributed/ranks.hpp"
#include "driftmesh/ids.hpp"

namespace driftmesh {

/// The ranks of the parts of this one: few parts move where that makes up for an imbalance; otherwise Zoltan chooses on
/// all ranks together, so that they take the same time and few bytes move, and few parts move from there. Empty while
/// the slowest rank takes at most a twentieth longer than the mean. Collective.
[[nodiscard]] std::vector<Rank> place_parts(MPI_Comm communicator, Ranks& ranks, const Decomposition& decomposition,
                                            const adapt::Loads& loads, const adapt::Generation& generation);

}  // namespace driftmesh
