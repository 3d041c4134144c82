// A doctest program for several ranks: each rank runs every test, and mpiexec fails if one of them does.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include "protocol/mpi/mpi_transport.hpp"

int main(int argc, char** argv) {
  doctest::Context context(argc, argv);
  const driftmesh::protocol::MpiSession session(argc, argv);
  const int result = context.run();
  // The other ranks may wait for this one forever.
  if (result != 0 && !context.shouldExit()) driftmesh::protocol::MpiSession::abort("a test failed on this rank");
  return result;
}
