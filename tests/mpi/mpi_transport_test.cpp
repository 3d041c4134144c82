#include "protocol/mpi/mpi_transport.hpp"

#include <doctest/doctest.h>

#include "protocol/transport_contract.hpp"
#include "support/delaying_transport.hpp"

using namespace driftmesh;
using namespace driftmesh::protocol;

TEST_CASE("MPI keeps the contract") {
  contract::check_transport_contract([](const contract::Program& program) {
    MpiTransport transport(MpiSession::world());
    run_rank(transport, program(transport));
    transport.close();
  });
}

TEST_CASE("MPI with random delays keeps the contract") {
  contract::check_transport_contract([](const contract::Program& program) {
    MpiTransport transport(MpiSession::world());
    DelayingTransport delaying(transport, 17, 30);
    run_rank(delaying, program(delaying));
    transport.close();
  });
}

TEST_CASE("two transports of the same ranks do not see each other's messages") {
  MpiTransport one(MpiSession::world()), other(MpiSession::world());
  const Rank next = next_in_ring(one.rank(), one.ranks());
  one.send(next, Bytes{std::byte{1}});
  other.send(next, Bytes{std::byte{2}});
  const auto get = [](MpiTransport& transport) {
    for (;;)
      if (const auto message = transport.poll()) return std::to_integer<int>(message->bytes.at(0));
  };
  CHECK(get(other) == 2);
  CHECK(get(one) == 1);
  CHECK(!one.poll());
  CHECK(!other.poll());
  one.close();
  other.close();
}

TEST_CASE("a message of several megabytes arrives in pieces, with others in between") {
  MpiTransport transport(MpiSession::world());
  contract::exchange([&](const contract::Program& program) { run_rank(transport, program(transport)); },
                     {3'000'000, 8, 2'000'000, 8, 8}, true);
  transport.close();
}
