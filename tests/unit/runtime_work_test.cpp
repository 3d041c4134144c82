#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <set>
#include <span>
#include <thread>
#include <utility>
#include <vector>

#include "base/thread_place.hpp"
#include "driftmesh/policy.hpp"
#include "protocol/packed_size.hpp"
#include "protocol/virtual_network.hpp"
#include "runtime/rank_loop.hpp"
#include "runtime/threads/thread_crew.hpp"
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
    return {.points = 5, .triangles = 10, .begun = triangles == 10, .seconds = seconds};
  }
  std::int64_t rest() override {
    CHECK(slices == 0);
    return 0;
  }
  [[nodiscard]] Bytes pack() const override { return Bytes(1); }

  int slices;
  std::int64_t triangles = 0;
  double remaining = 1;
  std::size_t backlog = 0;
  std::uint64_t packed_bytes = 100;
  double seconds = 0;  ///< of a slice

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

/// Two ranks on the same plan, the first of which holds toys and asks a policy that moves nothing.
struct TwoRanksOfToys {
  /// `seconds`: of a slice.
  explicit TwoRanksOfToys(std::size_t count, double seconds = 0) : plan(plan_of_toys(count)), toys(2) {
    for (const SubdomainId id : ids_of(plan.owners)) toys[0_rank].put(Toy(id, 100, worked)).seconds = seconds;
    balancer::Layout layout;
    layout.ranks = 2;
    layout.subdomains.resize(count);
    plan.layout = std::make_shared<const balancer::Layout>(layout);
    plan.policy = balancer::leader_policy([this](const balancer::LoadSnapshot& load) {
      plans.push_back(load);
      return std::vector<balancer::Move>{};
    });
    plan.balancing.options.gap = 0;
    plan.balancing.options.worth.gain = 0;
  }
  [[nodiscard]] Toy& toy(std::int32_t i) { return dynamic_cast<Toy&>(*toys[0_rank].find(SubdomainId{i})); }
  /// The seconds of the first rank.
  RankTimes run(const CostModel& costs = {}, const RankLoop::Observers& observers = {}) {
    protocol::VirtualNetwork network({IdVector<Rank, double>(2, 1.0), {}, 1e-6, 1e-6});
    std::vector<std::unique_ptr<RankLoop>> loops;
    IdVector<Rank, protocol::RankStep> steps;
    Apart apart;
    for (const Rank r : first_ids<Rank>(2)) {
      loops.push_back(std::make_unique<RankLoop>(network.transport(r), plan, toys[r], apart, costs, observers));
      steps.push_back([l = loops.back().get()] { return l->step(); });
    }
    transport = &network.transport(0_rank);
    REQUIRE(network.run(steps).end == protocol::RunEnd::kFinished);
    return loops[0]->times();
  }

  LoopPlan plan;
  std::vector<SubdomainId> worked;
  IdVector<Rank, Toys> toys;
  std::vector<balancer::LoadSnapshot> plans;  ///< what the policy was shown
  protocol::Transport* transport = nullptr;   ///< that of the first rank
};

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
    const IdVector<Rank, protocol::RankStep> steps{[&] {
      const protocol::StepResult result = loop.step();
      CHECK_FALSE(loop.can_abandon());  // nothing was thrown
      return result;
    }};
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

TEST_CASE("what an observer waits for makes its rank slow") {
  TwoRanksOfToys ranks(4, 1e-3);
  RankLoop::Observers observers;
  observers.after_slice = [&](const RankLoop&, const RankLoop::Slice& slice) {
    CHECK(slice.seconds == doctest::Approx(1e-3));
    ranks.transport->spend(1);
  };
  ranks.run({}, observers);
  double fastest = 0;
  for (const balancer::LoadSnapshot& load : ranks.plans) fastest = std::max(fastest, load.ranks[0_rank].speed);
  CHECK(fastest > 0);
  CHECK(fastest < 1000);
}

TEST_CASE("points that wait to be inserted are work") {
  TwoRanksOfToys ranks(2);
  ranks.toy(1).backlog = 5000;
  ranks.run();
  bool seen = false;
  for (const balancer::LoadSnapshot& load : ranks.plans)
    for (const balancer::SubdomainLoad& s : load.subdomains)
      if (s.id == 1_sub) {
        seen = true;
        CHECK(s.remaining >= 5001);
      }
  CHECK(seen);
}

TEST_CASE("a rank looks at its load less often where looking takes long") {
  const auto share_of_looking = [](double listed) {
    TwoRanksOfToys ranks(20, 1e-3);
    CostModel costs;
    costs.listed = listed;
    const RankTimes times = ranks.run(costs);
    return times.balancing / (times.balancing + times.computing);
  };
  CHECK(share_of_looking(1e-6) < 0.05);
  CHECK(share_of_looking(1e-3) < 0.05);
}

TEST_CASE("a rank plans less often where planning takes long") {
  const auto run = [](double factor) {
    TwoRanksOfToys ranks(20, 1e-2);
    ranks.plan.balancing.options.overhead = 0.002;
    CostModel costs;
    for (auto& [kind, seconds] : costs.planning.unit) seconds *= factor;
    const RankTimes times = ranks.run(costs);
    return std::pair(ranks.plans.size(), times.balancing / (times.balancing + times.computing));
  };
  const auto [often, little] = run(1);
  const auto [seldom, share] = run(1e4);
  CHECK(little < 0.004);
  CHECK(share < 0.004);
  CHECK(seldom < often);
}

TEST_CASE("each thread of a crew has its place, and says how long a shift took") {
  struct Slow final : Work {
    explicit Slow(SubdomainId id) : Work(id) {}
    [[nodiscard]] WorkState state() const override { return {.active = true}; }
    void tell(std::span<const SplitPoint<GlobalRootId>>) override {}
    SliceWork work(std::int64_t, std::vector<SplitPoint<GlobalRootId>>&) override {
      place = thread_place();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      return {};
    }
    [[nodiscard]] Bytes pack() const override { return {}; }
    std::size_t place = 0;
  };
  std::vector<Slow> works;
  for (int i = 0; i < 6; ++i) works.emplace_back(SubdomainId{i});
  std::vector<Shift> shifts(works.size());
  ThreadCrew crew(2);
  for (std::size_t i = 0; i < works.size(); ++i) {
    shifts[i].work = &works[i];
    crew.start(shifts[i]);
  }
  std::set<Shift*> finished;
  while (finished.size() < shifts.size()) {
    crew.wait();
    while (Shift* const shift = crew.finished()) CHECK(finished.insert(shift).second);
  }
  CHECK(thread_place() == 0);
  for (std::size_t i = 0; i < works.size(); ++i) {
    CHECK(shifts[i].seconds >= 5e-3);
    CHECK(works[i].place >= 1);
    CHECK(works[i].place <= 2);
  }
}
