#include <doctest/doctest.h>

#include "driftmesh/mesher.hpp"
#include "driftmesh/simulated.hpp"
#include "support/door_cases.hpp"

// The library's doors in one process. That of ranks is in tests/mpi, those of the program in tests/cli.

using namespace driftmesh;
using namespace driftmesh::testing;

TEST_CASE("all cases of the table behind the door of one piece") {
  check_door({"in one piece", [](MeshOptions options) {
                options.subdomains.count = 1;
                options.threads = 1;
                static_cast<void>(mesh(door_domain(), options));
              }});
}

TEST_CASE("all cases of the table behind the door of threads") {
  check_door({"on threads", [](MeshOptions options) {
                options.subdomains.count = 8;
                options.threads = 2;
                static_cast<void>(mesh(door_domain(), options));
              }});
}

TEST_CASE("all cases of the table behind the door of simulated ranks") {
  check_door({"on simulated ranks", [](MeshOptions options) {
                options.subdomains.count = 8;
                static_cast<void>(simulate(door_domain(), options, {.ranks = 3}));
              }});
}
