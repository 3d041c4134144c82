// A program in which one rank fails while the others wait for it: all must stop, with one message.
#include <exception>

#include "driftmesh/error.hpp"
#include "protocol/mpi/mpi_transport.hpp"
#include "protocol/rank_step.hpp"

using namespace driftmesh;
using namespace driftmesh::protocol;

int main(int argc, char** argv) {
  const MpiSession session(argc, argv);
  MpiTransport transport(MpiSession::world());
  try {
    run_rank(transport, [&] {
      if (transport.rank() == Rank{1}) throw Error("subdomain 7: the size field is not above 0 at (1, 2)");
      return transport.poll() ? StepResult::kFinished : StepResult::kIdle;
    });
    transport.close();
  } catch (const std::exception& error) {
    MpiSession::abort("driftmesh: rank " + to_string(transport.rank()) + ": " + error.what());
  }
}
