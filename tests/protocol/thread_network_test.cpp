#include "protocol/threads/thread_network.hpp"

#include <doctest/doctest.h>

#include <cstdint>
#include <exception>
#include <functional>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "protocol/toy_summary.hpp"
#include "protocol/transport_contract.hpp"
#include "support/delaying_transport.hpp"

using namespace driftmesh;
using namespace driftmesh::protocol;

namespace {

/// Runs the program on all ranks, each a thread, and passes on what the first that fails throws.
void run_on_threads(std::int32_t ranks, const std::function<void(Transport&)>& program) {
  ThreadNetwork network(ranks);
  std::vector<std::thread> threads;
  IdVector<Rank, std::exception_ptr> failures(to_index(ranks));
  for (const Rank r : first_ids<Rank>(ranks))
    threads.emplace_back([&, r] {
      try {
        program(network.transport(r));
      } catch (...) {  // doctest's REQUIRE throws what is no std::exception
        failures[r] = std::current_exception();
      }
    });
  for (std::thread& thread : threads) thread.join();
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

}  // namespace

TEST_CASE("threads keep the contract") {
  for (const std::int32_t ranks : {1, 2, 3, 7}) {
    CAPTURE(ranks);
    contract::check_transport_contract([&](const contract::Program& program) {
      run_on_threads(ranks, [&](Transport& transport) { run_rank(transport, program(transport)); });
    });
  }
}

TEST_CASE("threads with random delays keep the contract") {
  for (const std::uint64_t seed : {1, 2, 3}) {
    CAPTURE(seed);
    contract::check_transport_contract([&](const contract::Program& program) {
      run_on_threads(3, [&](Transport& transport) {
        DelayingTransport delaying(transport, seed, 30);
        run_rank(delaying, program(delaying));
      });
    });
  }
}

TEST_CASE("a message between threads is not copied") {
  ThreadNetwork network(2);
  Bytes bytes(1000);
  const std::byte* const place = bytes.data();
  network.transport(Rank{1}).send(Rank{0}, std::move(bytes));
  const auto received = network.transport(Rank{0}).poll();
  REQUIRE(received);
  CHECK(received->source == Rank{1});
  CHECK(received->bytes.data() == place);
}

TEST_CASE("an idle thread wakes when a message comes, and now and then without one") {
  ThreadNetwork network(2);
  Transport& idler = network.transport(Rank{0});
  for (int i = 0; i < 400; ++i) idler.idle();
  std::thread sender([&] { network.transport(Rank{1}).send(Rank{0}, Bytes(1)); });
  std::optional<Received> message;
  while (!message) {
    idler.idle();
    message = idler.poll();
  }
  sender.join();
  CHECK(message->bytes.size() == 1);
}

TEST_CASE("random work, moves and forwarding between threads, with random delays") {
  constexpr std::int32_t kRanks = 3;
  std::uint64_t points = 0, moves = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    CAPTURE(seed);
    const toy::World world(seed, kRanks);
    std::vector<std::vector<std::uint64_t>> summaries(kRanks);
    run_on_threads(kRanks, [&](Transport& transport) {
      DelayingTransport delaying(transport, seed, 20);
      toy::ToyRank rank(delaying, world);
      run_rank(delaying, [&] { return rank.step(); });
      CHECK(!rank.at_work());
      summaries[to_index(transport.rank())] = toy::summary(world, rank);
    });
    const auto total = [&](std::size_t i) { return summaries[0][i] + summaries[1][i] + summaries[2][i]; };
    const std::size_t edges = world.edges.size();
    for (std::size_t e = 0; e < edges; ++e) REQUIRE(total(e) == 0);
    REQUIRE(total(edges) == world.owners.size());
    points += total(edges + 1);
    moves += total(edges + 2);
  }
  CHECK(points > 1000);
  CHECK(moves > 100);
}
