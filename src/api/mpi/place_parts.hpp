#pragma once

#include <mpi.h>

#include <vector>

#include "adapt/generation.hpp"
#include "adapt/loads.hpp"
#include "decompose/decomposition.hpp"
#include "driftmesh/ids.hpp"

namespace driftmesh {

/// The ranks of the parts of this one, chosen by Zoltan on all ranks together so that they take the same time and few
/// bytes move; empty while the slowest rank takes at most a twentieth longer than the mean. Collective.
[[nodiscard]] std::vector<Rank> place_by_zoltan(MPI_Comm communicator, const Decomposition& decomposition,
                                                const adapt::Loads& loads, const adapt::Generation& generation);

}  // namespace driftmesh
