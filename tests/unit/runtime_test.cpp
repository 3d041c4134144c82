#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "balancer/policies/policy_factory.hpp"
#include "decompose/presplit.hpp"
#include "driftmesh/error.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/digest.hpp"
#include "mesh/exceptions.hpp"
#include "protocol/adversarial_network.hpp"
#include "protocol/transport_layer.hpp"
#include "protocol/virtual_network.hpp"
#include "runtime/plan_bytes.hpp"
#include "runtime/plan_run.hpp"
#include "support/id_literals.hpp"
#include "support/plans.hpp"
#include "support/policy_called.hpp"
#include "support/simulated_run.hpp"

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

/// An L with a square hole.
Pslg ell() {
  Pslg pslg;
  pslg.points = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}, {0.3, 0.3}, {0.6, 0.3}, {0.6, 0.6}, {0.3, 0.6}};
  for (std::int32_t i = 0; i < 6; ++i) pslg.segments.push_back({i, (i + 1) % 6, 1});
  for (std::int32_t i = 0; i < 4; ++i) pslg.segments.push_back({6 + i, 6 + (i + 1) % 4, 2});
  pslg.holes = {{0.45, 0.45}};
  return pslg;
}

RunPlan plan_of(const Pslg& pslg, const QualityBounds& bounds, std::int32_t ranks, std::int32_t subdomains,
                Presplit presplit) {
  RunPlan plan = plan_for(pslg, bounds, ranks, subdomains, presplit);
  plan.slice = 50;
  return plan;
}

std::uint64_t digest_of(const std::vector<const Subdomain*>& subdomains) {
  std::uint64_t sum = 0;
  for (const Subdomain* s : subdomains) sum += mesh_digest(s->mesh().mesh);
  return sum;
}

void check_mesh(const RunPlan& plan, const std::vector<const Subdomain*>& subdomains) {
  const auto problems = conformity_problems(plan.decomposition, subdomains);
  CHECK_MESSAGE(problems.empty(), (problems.empty() ? "" : problems[0]));
  for (const Subdomain* s : subdomains) {
    const Exceptions exceptions = find_exceptions(s->mesh().mesh, plan.bounds);
    CHECK(exceptions.large.empty());
    CHECK(exceptions.skinny.empty());
  }
}

}  // namespace

TEST_CASE("ranks on an adversarial network make one conforming mesh") {
  for (const std::int32_t ranks : {1, 2, 5})
    for (const Presplit presplit : {Presplit::kOn, Presplit::kOff})
      for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        CAPTURE(ranks);
        CAPTURE(seed);
        const RunPlan plan = plan_of(ell(), {20, 2e-3, {}, nullptr}, ranks, 12, presplit);
        protocol::AdversarialNetwork network(ranks, protocol::Adversary::from_seed(seed));
        SimulatedRanks run(network, ranks, plan);
        REQUIRE(network.run(run.steps).end == protocol::RunEnd::kFinished);
        CHECK(network.in_flight() == 0);
        check_mesh(plan, run.subdomains());
      }
}

TEST_CASE("with presplit interfaces a uniform bound needs no SPLIT, and the mesh depends on the decomposition alone") {
  std::uint64_t digest = 0;
  for (const std::int32_t ranks : {1, 2, 3, 7})
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const RunPlan plan = plan_of(ell(), {20, 1e-3, {}, nullptr}, ranks, 20, Presplit::kAuto);
      protocol::AdversarialNetwork network(ranks, protocol::Adversary::from_seed(seed));
      SimulatedRanks run(network, ranks, plan);
      REQUIRE(network.run(run.steps).end == protocol::RunEnd::kFinished);
      for (const auto& loop : run.loops) CHECK(loop->protocol().counters().splits_sent == 0);
      if (digest == 0) digest = digest_of(run.subdomains());
      CHECK(digest_of(run.subdomains()) == digest);
    }
}

TEST_CASE("the size bound splits no presplit interface whose pieces come out as long as they may be") {
  // The equilateral triangle of area 1 has edges of length 2 / 3^(1/4) = 1.51967...: just below it, and just above.
  for (const double length : {1.5196, 1.5198, 1.52})
    for (std::size_t i = 0; i < 20; ++i) {
      RunPlan plan = plan_of(ell(), {20, 1e-3, {}, nullptr}, 1, 20, Presplit::kOn);
      const auto& roots = plan.decomposition.roots;
      const auto root = std::find_if(roots.begin() + static_cast<std::ptrdiff_t>(i * roots.size() / 20), roots.end(),
                                     [](const Decomposition::Root& r) { return r.is_interface(); });
      if (root == roots.end()) break;
      const double whole =
          std::sqrt(squared_distance(plan.decomposition.points[root->a], plan.decomposition.points[root->b]));
      const double spacing = std::ldexp(whole / length, -static_cast<int>(std::ceil(std::log2(whole / 0.04))));
      plan.bounds.max_area = spacing * spacing;
      protocol::AdversarialNetwork network(1, protocol::Adversary::from_seed(1));
      SimulatedRanks run(network, 1, plan);
      REQUIRE(network.run(run.steps).end == protocol::RunEnd::kFinished);
      CAPTURE(length);
      CAPTURE(i);
      CHECK(run.loops.front()->interface_splits() == 0);
    }
}

TEST_CASE("subdomains that move while they refine make the same mesh as those that stay") {
  std::uint64_t digest = 0;
  std::int64_t moves = 0, forwarded = 0, held = 0;
  for (const Presplit presplit : {Presplit::kOn, Presplit::kOff})
    for (const std::int32_t ranks : {2, 3, 6})
      for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        CAPTURE(ranks);
        CAPTURE(seed);
        const RunPlan plan = plan_of(ell(), {20, 1e-3, {}, nullptr}, ranks, 20, presplit);
        protocol::AdversarialNetwork network(ranks, protocol::Adversary::from_seed(seed));
        SimulatedRanks run(network, ranks, plan);
        std::mt19937_64 random(seed);
        const auto move_something = [&](Rank r) {
          auto& loop = *run.loops[r];
          if (loop.subdomains().empty() || random() % 2 == 0) return;
          auto chosen = loop.subdomains().begin();
          std::advance(chosen, static_cast<std::ptrdiff_t>(random() % loop.subdomains().size()));
          loop.hand_over(chosen->first, static_cast<Rank>(random() % static_cast<std::uint64_t>(ranks)));
        };
        REQUIRE(network.run(run.steps, move_something).end == protocol::RunEnd::kFinished);
        check_mesh(plan, run.subdomains());
        for (const auto& loop : run.loops) {
          moves += loop->protocol().counters().hand_offs;
          forwarded += loop->protocol().counters().forwarded;
          held += loop->protocol().counters().held;
        }
        if (presplit == Presplit::kOff) continue;
        if (digest == 0) digest = digest_of(run.subdomains());
        CHECK(digest_of(run.subdomains()) == digest);
      }
  CHECK(moves > 400);
  CHECK(forwarded > 50);
  CHECK(held > 10);
}

TEST_CASE("in virtual time two ranks take about half as long as one") {
  const QualityBounds bounds{20, 3e-5, {}, nullptr};
  double seconds[2] = {};
  for (const std::int32_t ranks : {1, 2}) {
    const RunPlan plan = plan_of(ell(), bounds, ranks, 40, Presplit::kOff);
    protocol::VirtualNetwork network({IdVector<Rank, double>(to_index(ranks), 1.0), {}, 1e-6, 1e-6});
    SimulatedRanks run(network, ranks, plan);
    REQUIRE(network.run(run.steps).end == protocol::RunEnd::kFinished);
    check_mesh(plan, run.subdomains());
    seconds[ranks - 1] = network.makespan();
    for (const auto& loop : run.loops) {
      CHECK(loop->times().computing > 0.7 * network.makespan());
      CHECK(loop->times().total() <= doctest::Approx(network.makespan()));
    }
  }
  CHECK(seconds[1] < 0.6 * seconds[0]);
  CHECK(seconds[1] > 0.45 * seconds[0]);
}

TEST_CASE("finished subdomains that sleep wake when a point arrives that they do not hold") {
  std::int64_t asleep = 0, split = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    RunPlan plan = plan_of(ell(), {20, 1e-3, {}, nullptr}, 3, 20, Presplit::kOff);
    plan.sleep = true;
    protocol::AdversarialNetwork network(3, protocol::Adversary::from_seed(seed));
    SimulatedRanks run(network, 3, plan);
    REQUIRE(network.run(run.steps).end == protocol::RunEnd::kFinished);
    for (const auto& loop : run.loops) {
      split += loop->interface_splits();
      for (const auto& [id, subdomain] : loop->subdomains()) {
        asleep += subdomain.dormant();
        const_cast<Subdomain&>(subdomain).wake();
      }
    }
    check_mesh(plan, run.subdomains());
  }
  CHECK(asleep == 6 * 20);
  CHECK(split > 100);
}

TEST_CASE("subdomains that sleep when they are finished make one conforming mesh, and move asleep") {
  int asleep = 0, moved = 0;
  for (const Presplit presplit : {Presplit::kOn, Presplit::kOff})
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      CAPTURE(seed);
      RunPlan plan = plan_of(ell(), {20, 1e-3, {}, nullptr}, 3, 20, presplit);
      const SubdomainContext context{&plan.decomposition, plan.bounds, plan.presplit};
      std::uint64_t digest = 0;
      for (const bool sleep : {false, true}) {
        plan.sleep = sleep;
        protocol::AdversarialNetwork network(3, protocol::Adversary::from_seed(seed));
        SimulatedRanks run(network, 3, plan);
        const auto move_sleeper = [&](Rank r) {
          auto& loop = *run.loops[r];
          const auto sleeper = std::find_if(loop.subdomains().begin(), loop.subdomains().end(),
                                            [](const auto& s) { return s.second.dormant(); });
          if (sleeper == loop.subdomains().end() || seed % 2 == 0) return;
          loop.hand_over(sleeper->first, next_in_ring(r, 3));
          ++moved;
        };
        REQUIRE(network.run(run.steps, move_sleeper).end == protocol::RunEnd::kFinished);
        std::vector<Subdomain> awake;
        for (const Subdomain* s : run.subdomains()) {
          asleep += s->dormant();
          CHECK(s->dormant() == sleep);
          awake.push_back(Subdomain::unpack(s->pack(), context));
          awake.back().wake();
        }
        std::vector<const Subdomain*> all;
        for (const Subdomain& s : awake) all.push_back(&s);
        check_mesh(plan, all);
        if (!sleep) digest = digest_of(all);
        if (presplit == Presplit::kOn) CHECK(digest_of(all) == digest);
      }
    }
  CHECK(asleep == 2 * 8 * 20);
  CHECK(moved > 50);
}

TEST_CASE("every policy gives a slow rank less to do, and changes nothing about the mesh") {
  const QualityBounds bounds{20, 1e-4, {}, nullptr};
  const IdVector<Rank, double> speeds{1, 1, 0.25};
  std::uint64_t digest = 0;
  double without = 0;
  for (const std::string name : {"none", "zoltan", "stealing", "diffusion", "greedy"}) {
    CAPTURE(name);
    RunPlan plan = plan_of(ell(), bounds, 3, 120, Presplit::kOn);
    plan.slice = 500;
    plan.balancing.policy = name;
    prepare_balancing(plan, 3, balancer::make_policy);
    protocol::VirtualNetwork network({speeds, {}, 1e-6, 1e-6});
    // Long enough for reports and plans to matter: what takes a microsecond here takes a hundred on these ranks.
    CostModel slow;
    slow.point *= 100;
    SimulatedRanks run(network, 3, plan, slow);
    REQUIRE(network.run(run.steps).end == protocol::RunEnd::kFinished);
    check_mesh(plan, run.subdomains());
    if (digest == 0) digest = digest_of(run.subdomains());
    CHECK(digest_of(run.subdomains()) == digest);
    std::int64_t moved = 0;
    for (const auto& loop : run.loops) moved += loop->protocol().counters().hand_offs;
    if (name == "none") {
      without = network.makespan();
      CHECK(moved == 0);
    } else {
      CHECK(moved > 0);
      CHECK(network.makespan() < 0.7 * without);  // at best a third: 1 / 2.25 instead of 1 / 3 / 0.25
    }
  }
}

TEST_CASE("a rank that gives the run up takes the others with it, and nothing gets lost on the way") {
  std::int64_t early = 0;
  for (const PolicyCalled& called : {policy_called("none"), policy_called("stealing"), policy_called("diffusion"),
                                     policy_called("zoltan"), policy_called("collective")})
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
      CAPTURE(called.name);
      CAPTURE(seed);
      RunPlan plan = plan_of(ell(), {20, 3e-4, {}, nullptr}, 3, 20, Presplit::kOff);
      plan.balancing.policy = called.name;
      plan.balancing.parameters = called.parameters;
      plan.balancing.options.look = 3;
      plan.balancing.options.gap = 10;
      plan.balancing.options.interval = 300;
      prepare_balancing(plan, 3, balancer::make_policy);
      protocol::AdversarialNetwork network(3, protocol::Adversary::from_seed(seed));
      SimulatedRanks run(network, 3, plan);
      auto& quitter = run.loops[static_cast<Rank>(seed % 3)];
      bool was_at_work = false;
      run.steps[static_cast<Rank>(seed % 3)] = [&, steps = std::uint64_t{0}]() mutable {
        const auto result = quitter->step();
        if (++steps != 4 * seed || result == protocol::StepResult::kFinished) return result;
        was_at_work = quitter->at_work();
        quitter->abandon();
        return protocol::StepResult::kBusy;
      };
      REQUIRE(network.run(run.steps).end == protocol::RunEnd::kFinished);
      CHECK(network.in_flight() == 0);
      std::int64_t balance = 0;
      for (const auto& loop : run.loops) {
        if (was_at_work) CHECK(loop->abandoned());
        CHECK_FALSE(loop->at_work());
        balance += loop->protocol().termination().work_balance();
      }
      CHECK(balance == 0);
      early += was_at_work;
    }
  CHECK(early > 40);
}

TEST_CASE("what a slice of work throws leaves a loop that can give the run up") {
  struct Breaking final : SizeField {
    bool broken = false;
    double edge_length(const Point& p) const override {
      if (broken && p.x > 1.2) throw Error("no size here");
      return 0.1;
    }
  } field;
  const RunPlan plan = plan_of(ell(), {20, 0, {}, &field}, 2, 8, Presplit::kOff);
  protocol::AdversarialNetwork network(2, protocol::Adversary::from_seed(1));
  SimulatedRanks run(network, 2, plan);
  field.broken = true;
  int failures = 0;
  for (const Rank r : ids_of(run.loops))
    run.steps[r] = [&failures, loop = run.loops[r].get()] {
      try {
        return loop->step();
      } catch (const Error&) {
        CHECK(loop->can_abandon());
        ++failures;
        loop->abandon();
        return protocol::StepResult::kBusy;
      }
    };
  REQUIRE(network.run(run.steps).end == protocol::RunEnd::kFinished);
  CHECK(failures > 0);
  for (const auto& loop : run.loops) CHECK(loop->abandoned());
}

TEST_CASE("a rank that is through with its work alarms nobody before long") {
  struct Clocked final : protocol::TransportLayer {
    using TransportLayer::TransportLayer;
    [[nodiscard]] double now() const override { return time; }
    double time = 0;
  };
  const RunPlan plan = plan_of(ell(), {20, 1e-3, {}, nullptr}, 2, 6, Presplit::kOn);
  protocol::AdversarialNetwork network(2, {});
  Clocked transport(network.transport(1_rank));
  std::vector<std::string> alarms;
  RankLoop::Observers observers;
  observers.stalled = [&](const std::string& why) { alarms.push_back(why); };
  RankLoop loop(transport, plan, {}, observers);
  while (loop.step() != protocol::StepResult::kIdle) {
  }
  REQUIRE(!loop.at_work());
  // The other rank, which has the token, has not even begun.
  for (; transport.time < 590; transport.time += 10) CHECK(loop.step() == protocol::StepResult::kIdle);
  CHECK(alarms.empty());
  for (; transport.time < 700; transport.time += 10) CHECK(loop.step() == protocol::StepResult::kIdle);
  REQUIRE(!alarms.empty());
  CHECK(alarms[0].find("nothing has moved for 6") == 0);
  CHECK(alarms[0].find("without the token") != std::string::npos);
}

TEST_CASE("presplit points are in order, symmetric, and end at the spacing") {
  const RunPlan plan = plan_of(ell(), {20, 1e-3, {}, nullptr}, 1, 6, Presplit::kOn);
  std::size_t interfaces = 0;
  for (const GlobalRootId r : ids_of(plan.decomposition.roots)) {
    const auto& root = plan.decomposition.roots[r];
    const auto paths = presplit_paths(plan.decomposition, r, plan.bounds);
    if (!root.is_interface()) {
      CHECK(paths.empty());
      continue;
    }
    ++interfaces;
    const Point &a = plan.decomposition.points[root.a], &b = plan.decomposition.points[root.b];
    const double longest = kPresplitSpacing * std::sqrt(1e-3);
    int depth = -1;
    for (const dyadic::Path path : paths) depth = std::max(depth, dyadic::depth(path));
    const double length = std::hypot(a.x - b.x, a.y - b.y);
    CHECK(length / std::exp2(depth + 1) <= longest * (1 + 1e-12));
    if (depth >= 0) CHECK(length / std::exp2(depth) > longest * (1 - 1e-12));
  }
  CHECK(interfaces > 4);
}

TEST_CASE("a plan survives its way through bytes, and a damaged one is refused") {
  RunPlan plan = plan_of(ell(), {25, 1e-3, {0, 0.5}, nullptr}, 3, 9, Presplit::kOff);
  plan.aggregation = 17;
  plan.max_triangles = 12345;
  const Bytes bytes = plan_to_bytes(plan);
  const RunPlan copy = plan_from_bytes(bytes, 3);
  CHECK(copy.decomposition == plan.decomposition);
  CHECK(copy.owners == plan.owners);
  CHECK(copy.bounds.min_angle == 25);
  CHECK(copy.bounds.region_max_area == plan.bounds.region_max_area);
  CHECK(!copy.presplit);
  CHECK(copy.aggregation == 17);
  CHECK(copy.max_triangles == 12345);
  CHECK_THROWS_AS(plan_from_bytes(std::span(bytes).first(bytes.size() - 1), 3), Error);
  Bytes longer = bytes;
  longer.push_back({});
  CHECK_THROWS_AS(plan_from_bytes(longer, 3), Error);
}

TEST_CASE("the agenda finishes what is begun, and comes to refined subdomains last") {
  Agenda agenda(WorkOrder::kLargest);
  CHECK(!agenda.first());
  agenda.put({1_sub, false, false, 10, 0});
  agenda.put({2_sub, false, false, 30, 0});
  agenda.put({3_sub, false, true, 99, 5});
  agenda.put({4_sub, true, false, 1, 0});
  CHECK(agenda.first() == 4_sub);
  agenda.remove(4_sub);
  CHECK(agenda.first() == 2_sub);
  agenda.put({1_sub, false, false, 40, 0});
  CHECK(agenda.first() == 1_sub);
  agenda.remove(1_sub);
  agenda.remove(2_sub);
  CHECK(agenda.first() == 3_sub);
  agenda.put({5_sub, false, true, 1, 6});
  CHECK(agenda.first() == 5_sub);
  CHECK(agenda.size() == 2);
}

TEST_CASE("the watchdog barks once a patience") {
  Watchdog dog(60);
  CHECK(!dog.barks(1000));
  CHECK(!dog.barks(1059));
  CHECK(dog.barks(1060));
  CHECK(!dog.barks(1061));
  CHECK(dog.barks(1120));
  CHECK(dog.quiet(1120) == 120);
  dog.moved(1121);
  CHECK(!dog.barks(1180));
}

TEST_CASE("interfaces are not presplit where no bound says how finely") {
  CHECK(!plan_of(ell(), {20, 0, {}, nullptr}, 1, 4, Presplit::kAuto).presplit);
}
