#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "protocol/transport_contract.hpp"
#include "protocol/virtual_network.hpp"
#include "support/adversarial_network.hpp"
#include "support/delaying_transport.hpp"
#include "support/id_literals.hpp"

using namespace driftmesh;
using namespace driftmesh::protocol;

namespace {

template <class Network>
IdVector<Rank, RankStep> steps_on(Network& network, std::int32_t ranks, const contract::Program& program) {
  IdVector<Rank, RankStep> steps;
  for (const Rank r : first_ids<Rank>(ranks)) steps.push_back(program(network.transport(r)));
  return steps;
}

// Rank 0 sends `count` numbered messages to rank 1, which returns the order in which they arrive.
std::vector<int> order_of_arrival(AdversarialNetwork& network, int count) {
  std::vector<int> order;
  const IdVector<Rank, RankStep> steps{[&] {
                                         for (int i = 0; i < count; ++i)
                                           network.transport(0_rank).send(1_rank, Bytes{std::byte(i)});
                                         return StepResult::kFinished;
                                       },
                                       [&] {
                                         if (const auto message = network.transport(1_rank).poll())
                                           order.push_back(std::to_integer<int>(message->bytes[0]));
                                         return order.size() == static_cast<std::size_t>(count) ? StepResult::kFinished
                                                                                                : StepResult::kIdle;
                                       }};
  CHECK(network.run(steps).end == RunEnd::kFinished);
  return order;
}

}  // namespace

TEST_CASE("the adversarial network keeps the contract") {
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    const auto ranks = static_cast<std::int32_t>(seed % 4 + 1);
    CAPTURE(seed);
    contract::check_transport_contract([&](const contract::Program& program) {
      AdversarialNetwork network(ranks, Adversary::from_seed(seed));
      REQUIRE(network.run(steps_on(network, ranks, program)).end == RunEnd::kFinished);
      CHECK(network.in_flight() == 0);
    });
  }
}

TEST_CASE("virtual ranks keep the contract") {
  for (std::size_t ranks = 1; ranks <= 5; ++ranks)
    for (const std::int32_t ranks_per_host : {1, 2, 5}) {
      CAPTURE(ranks);
      CAPTURE(ranks_per_host);
      contract::check_transport_contract([&](const contract::Program& program) {
        VirtualCluster cluster{
            .speeds = IdVector<Rank, double>(ranks, 1.0), .link = {}, .ranks_per_host = ranks_per_host};
        cluster.speeds.back() = 0.25;
        VirtualNetwork network(cluster);
        REQUIRE(network.run(steps_on(network, static_cast<std::int32_t>(ranks), program)).end == RunEnd::kFinished);
      });
    }
}

TEST_CASE("a delaying transport keeps the contract, and reorders") {
  bool reordered = false;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    CAPTURE(seed);
    contract::check_transport_contract([&](const contract::Program& program) {
      VirtualNetwork network({.speeds = {1, 1, 2}, .link = {}});
      std::vector<std::unique_ptr<DelayingTransport>> delaying;
      IdVector<Rank, RankStep> steps;
      for (const Rank r : first_ids<Rank>(3)) {
        delaying.push_back(std::make_unique<DelayingTransport>(network.transport(r), seed, 20));
        // A virtual rank that waits is woken by arrivals only, not by the end of a delay.
        steps.push_back([step = program(*delaying.back())] {
          const auto result = step();
          return result == StepResult::kIdle ? StepResult::kBusy : result;
        });
      }
      REQUIRE(network.run(steps).end == RunEnd::kFinished);
    });
    AdversarialNetwork inner(1, {.seed = seed, .fifo = true, .may_copy = {}});
    DelayingTransport delaying(inner.transport(0_rank), seed, 10);
    for (int i = 0; i < 10; ++i) delaying.send(0_rank, Bytes{std::byte(i)});
    int last = -1;
    for (int got = 0; got < 10;)
      if (const auto message = delaying.poll()) {
        const int number = std::to_integer<int>(message->bytes[0]);
        reordered = reordered || number < last;
        last = number;
        ++got;
      }
  }
  CHECK(reordered);
}

TEST_CASE("the adversary does what it claims, reproducibly for a seed") {
  AdversarialNetwork::Counters sum;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(seed);
    auto adversary = Adversary::from_seed(seed);
    adversary.may_copy = [](Rank, std::span<const std::byte>) { return false; };
    AdversarialNetwork network(2, adversary), again(2, adversary);
    const auto order = order_of_arrival(network, 100);
    CHECK(order == order_of_arrival(again, 100));
    CHECK(network.counters().copies == 0);
    if (adversary.fifo) CHECK(std::is_sorted(order.begin(), order.end()));
    sum.delivered += network.counters().delivered;
    sum.reordered += network.counters().reordered;
    sum.starved += network.counters().starved;
    sum.held += network.counters().held;
  }
  CHECK(sum.delivered == 6000);
  CHECK(sum.reordered > 1000);
  CHECK(sum.starved > 100);
  CHECK(sum.held > 100);
}

TEST_CASE("the adversary duplicates only messages that allow it") {
  Adversary adversary{.seed = 5, .copy = 0.5, .may_copy = [](Rank, auto bytes) { return bytes[0] == std::byte{1}; }};
  AdversarialNetwork network(1, adversary);
  Transport& transport = network.transport(0_rank);
  std::array<int, 2> got{};
  for (int i = 0; i < 200; ++i) transport.send(0_rank, Bytes{std::byte(i % 2)});
  for (int i = 0; i < 2000; ++i)
    if (const auto message = transport.poll()) ++got[std::to_integer<std::size_t>(message->bytes[0])];
  CHECK(got[0] == 100);
  CHECK(got[1] > 120);
  CHECK(got[1] == 100 + static_cast<int>(network.counters().copies));
  CHECK(network.in_flight() == 0);
}

TEST_CASE("urgent messages come first, and held ones wait") {
  Adversary adversary{.seed = 6, .may_copy = {}};
  bool closed = true;
  adversary.urgency = [&](const Parcel& parcel, std::uint64_t) {
    if (parcel.bytes[0] == std::byte{0}) return closed ? Urgency::kNotYet : Urgency::kAnyTime;
    return parcel.bytes[0] == std::byte{1} ? Urgency::kFirst : Urgency::kAnyTime;
  };
  AdversarialNetwork network(1, adversary);
  Transport& transport = network.transport(0_rank);
  for (int i = 0; i < 30; ++i) transport.send(0_rank, Bytes{std::byte(i % 3)});
  std::vector<int> order;
  const auto poll = [&] {
    for (int i = 0; i < 300; ++i)
      if (const auto message = transport.poll()) order.push_back(std::to_integer<int>(message->bytes[0]));
  };
  poll();
  std::vector<int> expected(10, 1);
  expected.insert(expected.end(), 10, 2);
  CHECK(order == expected);
  closed = false;
  poll();
  expected.insert(expected.end(), 10, 0);
  CHECK(order == expected);
}

TEST_CASE("ranks that wait for each other stall and get a report") {
  const IdVector<Rank, RankStep> waiting(3, [] { return StepResult::kIdle; });
  CHECK(AdversarialNetwork(3, {.seed = 3, .may_copy = {}}).run(waiting).end == RunEnd::kStalled);
  CHECK(VirtualNetwork({.speeds = {1, 1, 1}, .link = {}}).run(waiting).end == RunEnd::kStalled);
  const IdVector<Rank, RankStep> busy(3, [] { return StepResult::kBusy; });
  CHECK(AdversarialNetwork(3, {.seed = 3, .may_copy = {}, .step_limit = 100}).run(busy).end == RunEnd::kStepLimit);
  CHECK(VirtualNetwork({.speeds = {1}, .link = {}, .step_limit = 100}).run(busy).end == RunEnd::kStepLimit);
}

TEST_CASE("virtual time follows from the cluster's parameters") {
  // Rank 0 works 3 s on the reference machine, at half speed; then sends 1 MB to rank 1, which waits for it.
  VirtualCluster cluster{.speeds = {0.5, 2}, .link = [](Rank, Rank) { return Link{0.25, 1e6}; }};
  cluster.message_overhead = 0.125;
  VirtualNetwork network(cluster);
  const IdVector<Rank, RankStep> steps{[&] {
                                         network.transport(0_rank).spend(3);
                                         network.transport(0_rank).send(1_rank, Bytes(500'000));
                                         network.transport(0_rank).send(1_rank, Bytes(500'000));
                                         return StepResult::kFinished;
                                       },
                                       [&, got = 0]() mutable {
                                         if (network.transport(1_rank).poll()) ++got;
                                         if (got < 2) return StepResult::kIdle;
                                         network.transport(1_rank).spend(1);
                                         return StepResult::kFinished;
                                       }};
  CHECK(network.run(steps).end == RunEnd::kFinished);
  CHECK(network.clock(0_rank) == doctest::Approx(6 + 2 * 0.125));
  // The second message leaves when the first has left, at 6.125 + 0.5; it arrives at 7.375, and is received at 7.5.
  CHECK(network.clock(1_rank) == doctest::Approx(6.125 + 0.5 + 0.5 + 0.25 + 0.125 + 0.5));
  CHECK(network.waited(1_rank) == doctest::Approx(7.375 - 0.125).epsilon(1e-4));
  CHECK(network.makespan() == network.clock(1_rank));
  CHECK(network.bytes() == 1'000'000);
  CHECK_THROWS_AS(VirtualNetwork({.speeds = {1, 0}, .link = {}}), Error);
}

TEST_CASE("work takes as long as the speed at each time says") {
  const SpeedSchedule schedule({{2, 0.5}, {4, 0}, {10, 2}});
  CHECK(schedule.end_of(0, 1) == 1);
  CHECK(schedule.end_of(0, 2) == 2);
  CHECK(schedule.end_of(1, 1.5) == 3);
  CHECK(schedule.end_of(1, 3) == 10.5);  // 1 s at full speed, 2 at half, 6 without the rank, and then twice as fast
  CHECK(schedule.end_of(5, 1) == 10.5);
  CHECK(schedule.end_of(20, 1) == 20.5);
  CHECK(schedule.done_by(3) == 2.5);
  CHECK(schedule.done_by(9) == 3);
  CHECK(schedule.done_by(11) == 5);
  CHECK(schedule.present_from(3) == 3);
  CHECK(schedule.present_from(4) == 10);
  std::mt19937_64 random(1);
  for (int i = 0; i < 1000; ++i) {  // end_of is the inverse of done_by
    const double start = std::uniform_real_distribution<double>(0, 12)(random);
    const double seconds = std::uniform_real_distribution<double>(0.001, 9)(random);
    const double end = schedule.end_of(start, seconds);
    REQUIRE(schedule.done_by(end) - schedule.done_by(start) == doctest::Approx(seconds));
  }
  CHECK_THROWS_AS(SpeedSchedule({{1, 0}}), Error);
  CHECK_THROWS_AS(SpeedSchedule({{2, 1}, {1, 1}}), Error);
  CHECK_THROWS_AS(SpeedSchedule({{2, 1}, {2, 3}}), Error);
  CHECK_THROWS_AS(SpeedSchedule({{2, 1}, {0, 3}}), Error);
  CHECK_THROWS_AS(SpeedSchedule({{-1, 1}}), Error);
  CHECK_THROWS_AS(SpeedSchedule({{1, -1}}), Error);
}

TEST_CASE("a rank that joins late gets its messages then") {
  VirtualCluster cluster{.speeds = {1, 1}, .link = [](Rank, Rank) { return Link{0.5, 1e9}; }};
  cluster.schedules = {SpeedSchedule(), SpeedSchedule({{0, 0}, {5, 1}})};
  VirtualNetwork network(cluster);
  double first_step = -1;
  const IdVector<Rank, RankStep> steps{[&] {
                                         network.transport(0_rank).send(1_rank, Bytes(1));
                                         return StepResult::kFinished;
                                       },
                                       [&] {
                                         if (first_step < 0) first_step = network.clock(1_rank);
                                         if (!network.transport(1_rank).poll()) return StepResult::kIdle;
                                         network.transport(1_rank).spend(1);
                                         return StepResult::kFinished;
                                       }};
  CHECK(network.run(steps).end == RunEnd::kFinished);
  CHECK(first_step == 5);
  CHECK(network.clock(1_rank) == doctest::Approx(6));
  cluster.schedules.resize(1);
  CHECK_THROWS_AS(VirtualNetwork{cluster}, Error);
}

namespace {

/// When rank 2 gets a message of ten bytes from rank 0, and one from rank 1, sent after so many seconds of work; at ten
/// bytes a second, on hosts of so many ranks.
std::array<double, 2> arrivals_at_two(std::int32_t ranks_per_host, std::array<double, 2> work) {
  VirtualNetwork network({.speeds = {1, 1, 1},
                          .link =
                              [](Rank, Rank) {
                                return Link{0.5, 10};
                              },
                          .message_overhead = 0,
                          .ranks_per_host = ranks_per_host,
                          .within_host = {0.25, 5}});
  std::array<double, 2> arrivals{};
  int heard = 0;
  const auto sender = [&](Rank r) -> RankStep {
    return [&, r] {
      network.transport(r).spend(work[to_index(r)]);
      network.transport(r).send(2_rank, Bytes(10));
      return StepResult::kFinished;
    };
  };
  const IdVector<Rank, RankStep> steps{sender(0_rank), sender(1_rank), [&] {
                                         while (const auto received = network.transport(2_rank).poll()) {
                                           arrivals[to_index(received->source)] = network.clock(2_rank);
                                           ++heard;
                                         }
                                         return heard == 2 ? StepResult::kFinished : StepResult::kIdle;
                                       }};
  REQUIRE(network.run(steps).end == RunEnd::kFinished);
  return arrivals;
}

}  // namespace

TEST_CASE("the ranks of a host share its line, in the order in which they send") {
  const auto at = [](double first, double second) {
    return std::array{doctest::Approx(first), doctest::Approx(second)};
  };
  const auto check = [&](std::int32_t ranks_per_host, std::array<double, 2> work,
                         const std::array<doctest::Approx, 2>& expected) {
    CAPTURE(ranks_per_host);
    const auto arrivals = arrivals_at_two(ranks_per_host, work);
    CHECK(arrivals[0] == expected[0]);
    CHECK(arrivals[1] == expected[1]);
  };
  check(1, {1, 1}, at(2.5, 2.5));
  check(2, {1, 1}, at(2.5, 3.5));
  check(2, {1, 1.25}, at(2.5, 3.5));
  check(2, {1, 5}, at(2.5, 6.5));
  check(2, {5, 1}, at(6.5, 2.5));  // what is sent later delays nothing, though its sender steps first
  check(2, {1.5, 1}, at(3.5, 2.5));
  const auto within = arrivals_at_two(3, {1, 1});
  CHECK(within[0] == doctest::Approx(1 + 2 + 0.25));  // through memory
  CHECK(within[1] == doctest::Approx(1 + 2 + 0.25));
  CHECK_THROWS_AS(VirtualNetwork({.speeds = {1}, .link = {}, .ranks_per_host = 0}), Error);
}

TEST_CASE("equal ranks with equal work finish together, whatever their number") {
  for (const std::size_t ranks : {1u, 10u, 1000u}) {
    VirtualNetwork network({.speeds = IdVector<Rank, double>(ranks, 1.0), .link = {}});
    const auto program = [](Transport& transport) -> RankStep {
      return [&transport, slices = 0]() mutable {
        transport.spend(0.001);
        return ++slices == 50 ? StepResult::kFinished : StepResult::kBusy;
      };
    };
    CHECK(network.run(steps_on(network, static_cast<std::int32_t>(ranks), program)).steps == 50 * ranks);
    CHECK(network.makespan() == doctest::Approx(0.05));
  }
}
