#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "decompose/presplit.hpp"
#include "geometry/triangle_geometry.hpp"
#include "runtime_fixture.hpp"
#include "support/adversarial_network.hpp"

using namespace driftmesh;
using namespace driftmesh::testing;

TEST_CASE("with presplit interfaces a uniform bound needs no SPLIT, and the mesh depends on the decomposition alone") {
  std::uint64_t digest = 0;
  for (const std::int32_t ranks : {1, 2, 3, 7})
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const RunPlan plan = plan_of(ell(), {20, {1e-3}, {}, nullptr}, ranks, 20, Presplit::kAuto);
      protocol::AdversarialNetwork network(ranks, protocol::Adversary::from_seed(seed));
      SimulatedRanks run(network, ranks, plan);
      REQUIRE(network.run(run.steps).end == protocol::RunEnd::kFinished);
      for (const auto& loop : run.loops) CHECK(loop->protocol().counters().splits_sent == 0);
      if (digest == 0) digest = digest_of(run.subdomains());
      CHECK(digest_of(run.subdomains()) == digest);
    }
}

TEST_CASE("decoupled ranks send nothing, and make the same mesh") {
  std::uint64_t digest = 0;
  for (const bool decoupled : {false, true})
    for (const std::int32_t ranks : {2, 3}) {
      RunPlan plan = plan_of(ell(), {20, {1e-3}, {}, nullptr}, ranks, 20, Presplit::kAuto);
      plan.work.decoupled = decoupled;
      protocol::AdversarialNetwork network(ranks, protocol::Adversary::from_seed(1));
      SimulatedRanks run(network, ranks, plan);
      REQUIRE(network.run(run.steps).end == protocol::RunEnd::kFinished);
      for (const auto& loop : run.loops) CHECK((loop->outcome().messages == 0) == decoupled);
      if (digest == 0) digest = digest_of(run.subdomains());
      CHECK(digest_of(run.subdomains()) == digest);
    }
}

TEST_CASE("a decoupled subdomain that needs a point on an interface is an error, and no other rank is told") {
  RunPlan plan = plan_of(ell(), {30, {0}, {}, nullptr}, 2, 20, Presplit::kAuto);  // nothing is presplit
  plan.work.decoupled = true;
  protocol::AdversarialNetwork network(2, protocol::Adversary::from_seed(1));
  SimulatedRanks run(network, 2, plan);
  std::string said;
  for (const auto& loop : run.loops) try {
      while (loop->step() != protocol::StepResult::kFinished) {
      }
    } catch (const Error& error) {
      said = error.what();
      REQUIRE(loop->can_abandon());
      loop->abandon();
      CHECK(loop->step() == protocol::StepResult::kFinished);
    }
  CHECK(said.find("needs another point on its border near (") != std::string::npos);
  for (const auto& loop : run.loops) CHECK(loop->outcome().messages == 0);
}

TEST_CASE("the size bound does not split presplit interfaces whose pieces are as long as allowed") {
  // The equilateral triangle of area 1 has edges of length 2 / 3^(1/4) = 1.51967...: just below it, and just above.
  for (const double length : {1.5196, 1.5198, 1.52})
    for (std::size_t i = 0; i < 20; ++i) {
      RunPlan plan = plan_of(ell(), {20, {1e-3}, {}, nullptr}, 1, 20, Presplit::kOn);
      const auto& roots = plan.decomposition.roots;
      const auto root = std::find_if(roots.begin() + static_cast<std::ptrdiff_t>(i * roots.size() / 20), roots.end(),
                                     [](const Decomposition::Root& r) { return r.is_interface(); });
      if (root == roots.end()) break;
      const double whole =
          std::sqrt(squared_distance(plan.decomposition.points[root->a], plan.decomposition.points[root->b]));
      const double spacing = std::ldexp(whole / length, -static_cast<int>(std::ceil(std::log2(whole / 0.04))));
      plan.bounds.plain.area = spacing * spacing;
      protocol::AdversarialNetwork network(1, protocol::Adversary::from_seed(1));
      SimulatedRanks run(network, 1, plan);
      REQUIRE(network.run(run.steps).end == protocol::RunEnd::kFinished);
      CAPTURE(length);
      CAPTURE(i);
      CHECK(run.loops.front()->interface_splits() == 0);
    }
}

TEST_CASE("presplit points are in order, symmetric, and end at the spacing") {
  const RunPlan plan = plan_of(ell(), {20, {1e-3}, {}, nullptr}, 1, 6, Presplit::kOn);
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

TEST_CASE("interfaces are not presplit without a bound on size") {
  CHECK(!plan_of(ell(), {20, {0}, {}, nullptr}, 1, 4, Presplit::kAuto).presplit);
}
