#include <doctest/doctest.h>
#include <mpi.h>

#include "driftmesh/mpi/distributed.hpp"
#include "support/door_cases.hpp"

// The library's door for the ranks of a communicator: the same cases as behind its other doors.

using namespace driftmesh;
using namespace driftmesh::testing;

TEST_CASE("all cases of the table behind the door of ranks") {
  check_door({.name = "on ranks",
              .open =
                  [](MeshOptions options) {
                    options.subdomains.count = 8;
                    static_cast<void>(mesh_distributed(MPI_COMM_WORLD, door_domain(), options));
                  },
              .on_ranks = true});
}
