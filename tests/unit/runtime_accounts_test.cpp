#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "driftmesh/error.hpp"
#include "driftmesh/policy.hpp"
#include "protocol/virtual_network.hpp"
#include "runtime_fixture.hpp"
#include "support/adversarial_network.hpp"
#include "support/simulated_crew.hpp"

// What a rank counts and says of itself, compared with what happened.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

/// Counts what a rank sends, and the time that it says to spend.
class CountedSends final : public protocol::Transport {
 public:
  explicit CountedSends(protocol::Transport& inner) : inner_(inner) {}
  [[nodiscard]] Rank rank() const override { return inner_.rank(); }
  [[nodiscard]] std::int32_t ranks() const override { return inner_.ranks(); }
  void send(Rank destination, Bytes bytes) override {
    ++messages;
    message_bytes += bytes.size();
    inner_.send(destination, std::move(bytes));
  }
  std::optional<protocol::Received> poll() override { return inner_.poll(); }
  void idle() override { inner_.idle(); }
  [[nodiscard]] double now() const override { return inner_.now(); }
  void spend(double seconds) override {
    spent += seconds;
    inner_.spend(seconds);
  }

  std::uint64_t messages = 0, message_bytes = 0;
  double spent = 0;

 private:
  protocol::Transport& inner_;
};

/// Work that costs nothing else.
CostModel a_second_for(double CostModel::*cost) {
  CostModel costs;
  for (double CostModel::*const other : {&CostModel::start, &CostModel::prepared, &CostModel::point, &CostModel::asleep,
                                         &CostModel::woken, &CostModel::packed_byte})
    costs.*other = 0;
  costs.*cost = 1;
  return costs;
}

std::int64_t triangles_in(const SubdomainLoop& loop) {
  std::int64_t sum = 0;
  for (const auto& [id, subdomain] : loop.subdomains()) sum += subdomain.triangles();
  return sum;
}

/// Passages of subdomains, by number and epoch, with destination and size.
using Passages = std::map<std::pair<SubdomainId, protocol::Epoch>, std::pair<Rank, std::size_t>>;

void note_passage(Passages& passages, const RankLoop::Passage& p) {
  CHECK(passages.emplace(std::pair(p.subdomain, p.epoch), std::pair(p.to, p.bytes)).second);
}

/// What happened on the ranks of a run with random moves, each counted where it happened.
void run_with_moves(const RunPlan& plan, std::int32_t ranks, std::uint64_t seed, std::int64_t& moved) {
  protocol::AdversarialNetwork network(ranks, protocol::Adversary::from_seed(seed));
  IdVector<Rank, std::unique_ptr<CountedSends>> transports;
  IdVector<Rank, std::unique_ptr<SubdomainLoop>> loops;
  IdVector<Rank, std::int64_t> said(to_index(ranks), 0), left(to_index(ranks), 0), came(to_index(ranks), 0);
  IdVector<Rank, protocol::RankStep> steps;
  IdVector<Rank, std::unique_ptr<SimulatedCrew>> crews;
  Passages handed_over, settled;
  const CostModel costs = a_second_for(&CostModel::packed_byte);
  IdVector<Rank, double> packed(to_index(ranks), 0);
  for (const Rank r : first_ids<Rank>(ranks)) {
    transports.push_back(std::make_unique<CountedSends>(network.transport(r)));
    RankLoop::Observers observers;
    observers.after_slice = [&said, r](const RankLoop&, const RankLoop::Slice& slice) {
      said[r] += static_cast<std::int64_t>(slice.said.size());
    };
    observers.handed_over = [&, r](const RankLoop&, const RankLoop::Passage& p) {
      ++left[r];
      packed[r] += static_cast<double>(p.bytes);
      note_passage(handed_over, p);
    };
    observers.settled = [&, r](const RankLoop& loop, const RankLoop::Passage& p) {
      ++came[r];
      packed[r] += static_cast<double>(p.bytes);
      CHECK(p.to == r);
      CHECK(loop.protocol().holds(p.subdomain));
      note_passage(settled, p);
    };
    loops.push_back(std::make_unique<SubdomainLoop>(*transports[r], plan, costs, observers));
    if (seed % 3 == 0) {
      crews.push_back(std::make_unique<SimulatedCrew>(2, seed + static_cast<std::uint64_t>(to_int(r))));
      loops[r]->hire(*crews.back());
    }
    steps.push_back([l = loops[r].get()] { return l->step(); });
  }
  std::mt19937_64 random(seed);
  const auto move_something = [&](Rank r) {
    SubdomainLoop& loop = *loops[r];
    if (loop.subdomains().empty() || random() % 3 != 0) return;
    auto chosen = loop.subdomains().begin();
    std::advance(chosen, static_cast<std::ptrdiff_t>(random() % loop.subdomains().size()));
    const SubdomainId id = chosen->first;
    const bool active = chosen->second.active();
    const auto to = static_cast<Rank>(random() % static_cast<std::uint64_t>(ranks));
    const std::int64_t before = loop.triangles(), here = chosen->second.triangles();
    const bool moves = loop.hand_over(id, to);
    if (to == r || !active) CHECK(!moves);
    CHECK(loop.subdomains().contains(id) == !moves);
    CHECK(loop.triangles() == (moves ? before - here : before));
    CHECK(!(moves && loop.hand_over(id, to)));
  };
  const auto after_step = [&](Rank r) {
    if (crews.empty()) REQUIRE(loops[r]->triangles() == triangles_in(*loops[r]));
    move_something(r);
  };
  REQUIRE(network.run(steps, after_step).end == protocol::RunEnd::kFinished);

  CHECK(handed_over == settled);
  std::map<SubdomainId, protocol::Epoch> last;
  for (const auto& [passage, where] : handed_over) CHECK(passage.second == ++last[passage.first]);
  std::vector<const Subdomain*> all;
  for (const Rank r : ids_of(loops)) {
    const RankOutcome outcome = loops[r]->outcome();
    CHECK(outcome.triangles == triangles_in(*loops[r]));
    CHECK(outcome.subdomains == static_cast<std::int32_t>(loops[r]->subdomains().size()));
    CHECK(outcome.interface_splits == said[r]);
    CHECK(outcome.messages == transports[r]->messages);
    CHECK(outcome.message_bytes == transports[r]->message_bytes);
    CHECK(outcome.counters.hand_offs == left[r]);
    CHECK(outcome.counters.arrivals == came[r]);
    CHECK(transports[r]->spent == packed[r]);
    moved += left[r];
    for (const auto& [id, subdomain] : loops[r]->subdomains()) {
      if (subdomain.dormant()) const_cast<Subdomain&>(subdomain).wake();
      all.push_back(&subdomain);
    }
  }
  check_mesh(plan, all);
}

/// The most triangles that one rank has between two slices of a run on a single one.
std::int64_t most_triangles(RunPlan plan) {
  protocol::VirtualNetwork network({IdVector<Rank, double>(1, 1.0), {}, 1e-6, 1e-6});
  std::int64_t most = 0;
  RankLoop::Observers observers;
  observers.after_slice = [&](const RankLoop& loop, const RankLoop::Slice&) {
    most = std::max(most, loop.triangles());
  };
  SubdomainLoop loop(network.transport(Rank{0}), plan, {}, observers);
  const IdVector<Rank, protocol::RankStep> steps{[&] { return loop.step(); }};
  REQUIRE(network.run(steps).end == protocol::RunEnd::kFinished);
  return most;
}

}  // namespace

TEST_CASE("what ranks count is what happened, whatever moves and sleeps") {
  std::int64_t moved = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    CAPTURE(seed);
    RunPlan plan = plan_of(ell(), {20, {1e-3}, {}, nullptr}, 3, 20, seed % 2 == 0 ? Presplit::kOn : Presplit::kOff);
    plan.work.slice = 30;
    plan.work.sleep = seed % 4 < 2;
    run_with_moves(plan, 3, seed, moved);
  }
  CHECK(moved > 100);
}

TEST_CASE("a rank may have as many triangles as its limit says, and not one more") {
  RunPlan plan = plan_of(ell(), {20, {1e-3}, {}, nullptr}, 1, 8, Presplit::kOff);
  const std::int64_t most = most_triangles(plan);
  REQUIRE(most > 1000);
  plan.max_triangles = most;
  CHECK(most_triangles(plan) == most);
  plan.max_triangles = most - 1;
  protocol::VirtualNetwork network({IdVector<Rank, double>(1, 1.0), {}, 1e-6, 1e-6});
  SubdomainLoop loop(network.transport(Rank{0}), plan);
  const IdVector<Rank, protocol::RankStep> steps{[&] { return loop.step(); }};
  CHECK_THROWS_AS((void)network.run(steps), LimitError);
  CHECK(loop.can_abandon());
  CHECK(loop.triangles() == most);
}

TEST_CASE("the balancer hears of the work and the memory that a rank has") {
  for (const bool sleep : {false, true})
    for (const double host_room : {1e300, 1e9, 500.0}) {
      CAPTURE(host_room);
      RunPlan plan = plan_of(ell(), {20, {1e-4}, {}, nullptr}, 2, 40, Presplit::kOff);
      plan.work.sleep = sleep;
      for (Rank& owner : plan.owners) owner = Rank{0};
      plan.max_triangles = 60'000;
      std::unique_ptr<SimulatedRanks> run;
      int looks = 0, in_the_middle = 0;
      std::set<double> rooms;
      const auto look = [&](const balancer::LoadSnapshot& load) {
        ++looks;
        const SubdomainLoop& loop = *run->loops[Rank{0}];
        const balancer::RankLoad& own = load.ranks[Rank{0}];
        double work = 0;
        std::size_t listed = 0;
        for (const balancer::SubdomainLoad& s : load.subdomains) {
          if (s.owner != Rank{0}) continue;
          const Subdomain& subdomain = loop.subdomains().at(s.id);
          CHECK(subdomain.active());
          CHECK(s.bytes == subdomain.packed_bytes());
          CHECK(s.remaining >= 1);
          in_the_middle += subdomain.started();
          work += s.remaining;
          ++listed;
        }
        CHECK(listed == static_cast<std::size_t>(
                            std::ranges::count_if(loop.subdomains(), [](const auto& s) { return s.second.active(); })));
        CHECK(own.remaining == doctest::Approx(work));
        const double room = std::min(static_cast<double>(60'000 - loop.triangles()), host_room);
        CHECK(own.free_memory == doctest::Approx(std::max(0.0, room - 1.05 * work)));
        rooms.insert(own.free_memory);
        return std::vector<balancer::Move>{};
      };
      plan.policy = balancer::leader_policy(look);
      plan.layout = layout_of(plan, 2);
      protocol::VirtualNetwork network({IdVector<Rank, double>(2, 1.0), {}, 1e-6, 1e-6});
      CostModel slow;
      slow.point *= 300;
      run = std::make_unique<SimulatedRanks>(network, 2, plan, slow);
      if (host_room < 1e300) run->loops[Rank{0}]->limit_memory([&] { return host_room; });
      REQUIRE(network.run(run->steps).end == protocol::RunEnd::kFinished);
      CHECK(looks > 3);
      CHECK(in_the_middle > 0);
      if (host_room > 500) CHECK(rooms.size() > 3);
    }
}

TEST_CASE("times of a rank follow from what its work costs") {
  const auto seconds_with = [](double CostModel::*cost, bool sleep, Presplit presplit) {
    RunPlan plan = plan_of(ell(), {20, {1e-3}, {}, nullptr}, 1, 12, presplit);
    plan.work.sleep = sleep;
    const CostModel costs = a_second_for(cost);
    protocol::VirtualNetwork network({IdVector<Rank, double>(1, 1.0), {}, 1e-9, 1e-9});
    SimulatedRanks run(network, 1, plan, costs);
    REQUIRE(network.run(run.steps).end == protocol::RunEnd::kFinished);
    std::int64_t points = 0, triangles = 0;
    for (const Subdomain* s : run.subdomains()) {
      points += s->counters().free_points + s->counters().segment_points;
      triangles += s->triangles();
    }
    return std::tuple(network.makespan(), static_cast<double>(points), static_cast<double>(triangles));
  };
  const auto [by_points, points, of_points] = seconds_with(&CostModel::point, false, Presplit::kOff);
  CHECK(by_points == doctest::Approx(points).epsilon(1e-3));
  CHECK(std::get<0>(seconds_with(&CostModel::start, false, Presplit::kOff)) == doctest::Approx(12).epsilon(1e-3));
  CHECK(std::get<0>(seconds_with(&CostModel::woken, false, Presplit::kOff)) < 1e-2);
  const auto [by_sleep, made, asleep] = seconds_with(&CostModel::asleep, true, Presplit::kOn);
  CHECK(by_sleep >= asleep * 0.999);
  // Neighbors' points wake some, which fall asleep again.
  const auto [by_waking, made_again, woken] = seconds_with(&CostModel::woken, true, Presplit::kOff);
  const auto slept_in_all = std::get<0>(seconds_with(&CostModel::asleep, true, Presplit::kOff));
  CHECK(by_waking > 0.05 * woken);
  CHECK(slept_in_all > 1.05 * woken);
}
