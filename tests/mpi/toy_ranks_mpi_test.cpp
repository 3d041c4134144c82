#include <doctest/doctest.h>
#include <mpi.h>

#include "protocol/mpi/mpi_transport.hpp"
#include "protocol/toy_summary.hpp"
#include "support/delaying_transport.hpp"

using namespace driftmesh::protocol;
using namespace driftmesh::protocol::toy;

namespace {

std::vector<std::uint64_t> sum_over_ranks(std::vector<std::uint64_t> values) {
  MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_UINT64_T, MPI_SUM, MPI_COMM_WORLD);
  return values;
}

}  // namespace

TEST_CASE("random work, moves and forwarding on real ranks, with random delays") {
  std::uint64_t points = 0, moves = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    MpiTransport transport(MpiSession::world());
    DelayingTransport delaying(transport, seed, 20);
    const World world(seed, transport.ranks());
    ToyRank rank(delaying, world);
    run_rank(delaying, [&] { return rank.step(); });
    CHECK(!rank.at_work());
    transport.close();

    const auto total = sum_over_ranks(summary(world, rank));
    for (std::size_t e = 0; e < world.edges.size(); ++e) REQUIRE(total[e] == 0);
    REQUIRE(total[world.edges.size()] == world.owners.size());
    points += total[world.edges.size() + 1];
    moves += total.back();
  }
  int ranks = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  CHECK(points > 1000);
  CHECK(moves >= (ranks == 1 ? 0u : 50u));
}
