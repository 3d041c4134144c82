#include <doctest/doctest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <set>
#include <string>

#include "balancer/policies/policy_factory.hpp"
#include "protocol/virtual_network.hpp"
#include "runtime_fixture.hpp"
#include "support/adversarial_network.hpp"

using namespace driftmesh;
using namespace driftmesh::testing;

TEST_CASE("ranks on an adversarial network make one conforming mesh") {
  for (const std::int32_t ranks : {1, 2, 5})
    for (const Presplit presplit : {Presplit::kOn, Presplit::kOff})
      for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        CAPTURE(ranks);
        CAPTURE(seed);
        const RunPlan plan = plan_of(ell(), {20, {2e-3}, {}, nullptr}, ranks, 12, presplit);
        protocol::AdversarialNetwork network(ranks, protocol::Adversary::from_seed(seed));
        SimulatedRanks run(network, ranks, plan);
        REQUIRE(network.run(run.steps).end == protocol::RunEnd::kFinished);
        CHECK(network.in_flight() == 0);
        check_mesh(plan, run.subdomains());
      }
}

TEST_CASE("subdomains that move during refinement make the same mesh as those that stay") {
  std::uint64_t digest = 0;
  std::int64_t moves = 0, forwarded = 0, held = 0;
  for (const Presplit presplit : {Presplit::kOn, Presplit::kOff})
    for (const std::int32_t ranks : {2, 3, 6})
      for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        CAPTURE(ranks);
        CAPTURE(seed);
        const RunPlan plan = plan_of(ell(), {20, {1e-3}, {}, nullptr}, ranks, 20, presplit);
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

TEST_CASE("each subdomain is told of when it is finished, and once if nothing comes from its neighbors") {
  const RunPlan plan = plan_of(ell(), {20, {1e-3}, {}, nullptr}, 2, 12, Presplit::kOn);
  protocol::VirtualNetwork network({IdVector<Rank, double>(2, 1.0), {}, 1e-6, 1e-6});
  std::multiset<SubdomainId> finished;
  IdVector<Rank, std::unique_ptr<SubdomainLoop>> loops;
  IdVector<Rank, protocol::RankStep> steps;
  for (const Rank r : first_ids<Rank>(2)) {
    const auto note = [&finished](const Subdomain& subdomain) {
      CHECK_FALSE(subdomain.active());
      finished.insert(subdomain.id());
    };
    loops.push_back(
        std::make_unique<SubdomainLoop>(network.transport(r), plan, CostModel{}, RankLoop::Observers{}, note));
    steps.push_back([l = loops[r].get()] { return l->step(); });
  }
  REQUIRE(network.run(steps).end == protocol::RunEnd::kFinished);
  std::multiset<SubdomainId> all;
  for (const SubdomainId s : ids_of(plan.owners)) all.insert(s);
  CHECK(finished == all);
}

TEST_CASE("in virtual time two ranks take about half as long as one") {
  const QualityBounds bounds{20, {3e-5}, {}, nullptr};
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

TEST_CASE("every policy gives a slow rank less work and leaves the mesh unchanged") {
  const QualityBounds bounds{20, {1e-4}, {}, nullptr};
  const IdVector<Rank, double> speeds{1, 1, 0.25};
  std::uint64_t digest = 0;
  double without = 0;
  for (const std::string name : {"none", "zoltan", "stealing", "diffusion", "greedy"}) {
    CAPTURE(name);
    RunPlan plan = plan_of(ell(), bounds, 3, 120, Presplit::kOn);
    plan.work.slice = 500;
    plan.balancing.policy = name;
    prepare_balancing(plan, 3, balancer::make_policy);
    protocol::VirtualNetwork network({speeds, {}, 1e-6, 1e-6});
    // Slow enough for reports and plans to matter: what takes a microsecond here takes a hundred on these ranks.
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

TEST_CASE("a rank that is asked for work gives some before its next slice, however long that is") {
  RunPlan plan = plan_of(ell(), {20, {1e-4}, {}, nullptr}, 2, 40, Presplit::kOn);
  plan.work.slice = 1'000'000;
  for (Rank& owner : plan.owners) owner = Rank{0};
  plan.balancing.policy = "stealing";
  prepare_balancing(plan, 2, balancer::make_policy);
  protocol::VirtualNetwork network({IdVector<Rank, double>(2, 1.0), {}, 1e-6, 1e-6});
  CostModel slow;
  slow.point *= 1000;  // the first slice is longer than it takes to ask
  SimulatedRanks run(network, 2, plan, slow);
  std::vector<double> ends;  // ends of slices on rank 0
  double arrival = 0;        // the first subdomain at rank 1
  const IdVector<Rank, protocol::RankStep> steps{[&] {
                                                   const auto result = run.steps[Rank{0}]();
                                                   ends.push_back(network.transport(Rank{0}).now());
                                                   return result;
                                                 },
                                                 [&] {
                                                   const auto result = run.steps[Rank{1}]();
                                                   if (arrival == 0 && !run.loops[Rank{1}]->subdomains().empty())
                                                     arrival = network.transport(Rank{1}).now();
                                                   return result;
                                                 }};
  REQUIRE(network.run(steps).end == protocol::RunEnd::kFinished);
  check_mesh(plan, run.subdomains());
  REQUIRE(ends.size() > 2);
  CHECK(arrival > ends[0]);
  CHECK(arrival < ends[1] + ends[0]);  // with the first slice of rank 1, as long as that of rank 0
}
