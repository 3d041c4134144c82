#include <doctest/doctest.h>

#include <cstdint>
#include <vector>

#include "protocol/packed_size.hpp"
#include "protocol/virtual_network.hpp"
#include "runtime/rank_loop.hpp"
#include "support/id_literals.hpp"
#include "support/simulated_crew.hpp"

// The loop of a rank on work that says what the test wants.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

/// Takes some slices, each of which makes ten triangles, and notes when.
class Toy final : public Work {
 public:
  Toy(SubdomainId id, int count, std::vector<SubdomainId>& worked) : Work(id), slices(count), worked_(&worked) {}

  [[nodiscard]] WorkState state() const override {
    return {.active = slices > 0,
            .started = triangles > 0,
            .refined = false,
            .backlog = backlog,
            .triangles = triangles,
            .predicted = remaining,
            .forecast = remaining,
            .remaining = remaining,
            .packed_bytes = packed_bytes};
  }
  void tell(std::span<const SplitPoint<GlobalRootId>>) override {}
  SliceWork work(std::int64_t, std::vector<SplitPoint<GlobalRootId>>& said) override {
    worked_->push_back(id());
    --slices;
    triangles += 10;
    said.push_back({GlobalRootId{0}, 1});
    return {.points = 5, .triangles = 10, .begun = triangles == 10};
  }
  [[nodiscard]] Bytes pack() const override { return Bytes(1); }

  int slices;
  std::int64_t triangles = 0;
  double remaining = 1;
  std::size_t backlog = 0;
  std::uint64_t packed_bytes = 100;

 private:
  std::vector<SubdomainId>* worked_;
};

class Toys final : public HoldingOf<Toy> {
 public:
  Work& unpack(std::span<const std::byte>) override { throw Error("nothing comes here"); }
};

/// Nobody else is told of anything.
class Apart final : public Coupling {
 public:
  [[nodiscard]] std::optional<SubdomainId> to_tell(SubdomainId, const SplitPoint<GlobalRootId>&) override { return {}; }
  [[nodiscard]] std::int32_t roots() const override { return 1; }
};

LoopPlan plan_of_toys(std::size_t count, WorkOrder order = WorkOrder::kGiven) {
  LoopPlan plan;
  plan.owners = IdVector<SubdomainId, Rank>(count, 0_rank);
  plan.work.order = order;
  return plan;
}

}  // namespace

TEST_CASE("work is done in the order of the plan, what was begun first, and what is done is not worked on again") {
  constexpr double kRemaining[] = {3, 9, 1, 7, 5};
  constexpr std::size_t kBacklog[] = {0, 2, 5, 1, 4};
  const auto order = [&](WorkOrder wanted, int slices) {
    std::vector<SubdomainId> worked;
    Toys toys;
    for (int i = 0; i < 5; ++i) {
      Toy& toy = toys.put(Toy(SubdomainId{i}, slices, worked));
      toy.remaining = kRemaining[i];
      toy.backlog = kBacklog[i];
    }
    const LoopPlan plan = plan_of_toys(5, wanted);
    protocol::VirtualNetwork network({IdVector<Rank, double>(1, 1.0), {}});
    Apart apart;
    RankLoop loop(network.transport(0_rank), plan, toys, apart);
    const IdVector<Rank, protocol::RankStep> steps{[&] { return loop.step(); }};
    REQUIRE(network.run(steps).end == protocol::RunEnd::kFinished);
    CHECK(loop.triangles() == 5 * slices * 10);
    CHECK(loop.interface_splits() == 5 * slices);
    return worked;
  };
  using Order = std::vector<SubdomainId>;
  CHECK(order(WorkOrder::kGiven, 1) == Order{0_sub, 1_sub, 2_sub, 3_sub, 4_sub});
  CHECK(order(WorkOrder::kLargest, 1) == Order{1_sub, 3_sub, 4_sub, 0_sub, 2_sub});
  CHECK(order(WorkOrder::kBacklog, 1) == Order{2_sub, 4_sub, 1_sub, 3_sub, 0_sub});
  CHECK(order(WorkOrder::kLargest, 2) == Order{1_sub, 1_sub, 3_sub, 3_sub, 4_sub, 4_sub, 0_sub, 0_sub, 2_sub, 2_sub});
}

TEST_CASE("what is too large for one message stays, and so does what has nothing to do") {
  std::vector<SubdomainId> worked;
  Toys toys;
  toys.put(Toy(0_sub, 3, worked)).packed_bytes = protocol::kMostPackedBytes + 1;
  toys.put(Toy(1_sub, 3, worked)).packed_bytes = protocol::kMostPackedBytes;
  toys.put(Toy(2_sub, 0, worked));
  const LoopPlan plan = plan_of_toys(3);
  protocol::VirtualNetwork network({IdVector<Rank, double>(2, 1.0), {}});
  Apart apart;
  RankLoop loop(network.transport(0_rank), plan, toys, apart);
  CHECK_FALSE(loop.hand_over(0_sub, 1_rank));
  CHECK_FALSE(loop.hand_over(1_sub, 0_rank));
  CHECK(loop.hand_over(1_sub, 1_rank));
  CHECK_FALSE(loop.hand_over(1_sub, 1_rank));
  CHECK_FALSE(loop.hand_over(2_sub, 1_rank));
  CHECK(toys.find(0_sub) != nullptr);
  CHECK(toys.find(1_sub) == nullptr);
}

TEST_CASE("what a crew still works on when the run is given up counts no more") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::vector<SubdomainId> worked;
    Toys toys;
    for (int i = 0; i < 8; ++i) toys.put(Toy(SubdomainId{i}, 50, worked));
    const LoopPlan plan = plan_of_toys(8);
    protocol::VirtualNetwork network({IdVector<Rank, double>(1, 1.0), {}});
    Apart apart;
    SimulatedCrew crew(2, seed);
    RankLoop loop(network.transport(0_rank), plan, toys, apart);
    loop.hire(crew);
    for (int k = 0; k < 20; ++k) (void)loop.step();
    loop.abandon();
    const std::int64_t triangles = loop.triangles(), splits = loop.interface_splits();
    const std::size_t slices = worked.size();
    const IdVector<Rank, protocol::RankStep> steps{[&] { return loop.step(); }};
    REQUIRE(network.run(steps).end == protocol::RunEnd::kFinished);
    CHECK(worked.size() > slices);  // the crew's
    CHECK(loop.triangles() == triangles);
    CHECK(loop.interface_splits() == splits);
    CHECK_FALSE(loop.at_work());
  }
}
