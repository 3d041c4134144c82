#pragma once

#include <mpi.h>

#include <exception>

namespace driftmesh {

/// For a rank that cannot make the arguments of one of the functions of driftmesh/mpi/distributed.hpp, which the other
/// ranks call: takes part in its place, so that all ranks throw `failure`, with the number of the rank. Collective.
void fail_together(MPI_Comm communicator, const std::exception_ptr& failure);

}  // namespace driftmesh
