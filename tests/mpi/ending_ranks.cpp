// A program whose ranks have nothing to do but to end.
#include "protocol/mpi/mpi_transport.hpp"

int main(int argc, char** argv) {
  const driftmesh::protocol::MpiSession session(argc, argv);
}
