#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <memory>

#include "balancer/policies/policy_factory.hpp"
#include "driftmesh/error.hpp"
#include "runtime_fixture.hpp"
#include "support/id_literals.hpp"

// What a run is to be, from its options.

using namespace driftmesh;
using namespace driftmesh::testing;

TEST_CASE("twenty subdomains for each rank, and more where these exceed a cache") {
  CHECK(default_subdomains(1000, 1) == 20);
  CHECK(default_subdomains(1000, 7) == 140);
  CHECK(default_subdomains(400'000, 1) == 20);
  CHECK(default_subdomains(400'001, 1) == 21);
  CHECK(default_subdomains(1e7, 4) == 500);
  CHECK(default_subdomains(1e300, 1) == 1'000'000);
}

TEST_CASE("a domain that cannot be cut as often as the default wants is cut less often") {
  // Too thin for separators, at any place.
  Pslg strip;
  strip.points = {{0, 0}, {1, 0}, {1, 1e-6}, {0, 1e-6}};
  for (std::int32_t i = 0; i < 4; ++i) strip.segments.push_back({i, (i + 1) % 4, 1});
  const Triangulation mesh = triangulate(strip);
  DecomposeOptions options;
  options.bounds.plain.area = 1;
  options.subdomains = 0;  // the default
  CHECK(decompose_for(mesh, options, 1).size() == 1);
  options.subdomains = default_subdomains(1, 1);
  CHECK_THROWS_AS(static_cast<void>(decompose_for(mesh, options, 1)), Error);  // what is asked for must be possible
}

TEST_CASE("a plan keeps the owners that are given, and takes slices of one insertion or more") {
  const QualityBounds bounds{20, {1e-3}, {}, nullptr};
  const RunPlan made = plan_of(ell(), bounds, 3, 12, Presplit::kAuto);
  PlanOptions options;
  options.mapping.ranks = 3;
  options.owners = IdVector<SubdomainId, Rank>(made.decomposition.size(), 2_rank);
  options.owners[0_sub] = 1_rank;
  const RunPlan plan = plan_run(made.decomposition, bounds, options);
  CHECK(plan.owners == options.owners);
  CHECK(plan.presplit);
  CHECK_FALSE(plan_run(made.decomposition, QualityBounds{}, options).presplit);
  options.presplit = Presplit::kOff;
  CHECK_FALSE(plan_run(made.decomposition, bounds, options).presplit);
  CHECK(forecast_of(plan, 0_rank) == 0);
  CHECK(forecast_of(plan, 1_rank) == plan.decomposition.subdomains[0_sub].predicted);
  CHECK(forecast_of(plan, 1_rank) + forecast_of(plan, 2_rank) == doctest::Approx(forecast_of(plan)));
  CHECK(forecast_of(plan) > 100);
  for (const std::int64_t slice : {1, 0, -5}) {
    options.work.slice = slice;
    if (slice > 0)
      CHECK_NOTHROW(static_cast<void>(plan_run(made.decomposition, bounds, options)));
    else
      CHECK_THROWS_AS(static_cast<void>(plan_run(made.decomposition, bounds, options)), Error);
  }
}

TEST_CASE("a balancer knows of the work of subdomains, of borders from both sides, and which lie on segments") {
  RunPlan plan = plan_of(ell(), {20, {1e-3}, {}, nullptr}, 3, 40, Presplit::kOn);
  plan.balancing.policy = "none";
  prepare_balancing(plan, 3, balancer::make_policy);
  CHECK(plan.policy == nullptr);
  CHECK(plan.layout == nullptr);
  plan.balancing.policy = "greedy";
  plan.balancing.options.work_to_start = 77;
  prepare_balancing(plan, 3, balancer::make_policy);
  CHECK(plan.policy != nullptr);
  REQUIRE(plan.layout != nullptr);
  std::size_t inside = 0, borders = 0;
  for (const SubdomainId s : ids_of(plan.owners)) {
    const auto& known = (*plan.layout)[s];
    CHECK(known.predicted == 77 + plan.decomposition.subdomains[s].predicted);
    CHECK(known.owner == plan.owners[s]);
    bool outside = false;
    for (const GlobalRootId r : plan.decomposition.roots_of(s)) {
      const auto& root = plan.decomposition.roots[r];
      outside = outside || root.left == kNoSubdomain || root.right == kNoSubdomain || !root.separator;
    }
    CHECK(known.on_segments == outside);
    inside += outside ? 0 : 1;
    for (const balancer::Neighbor& n : known.neighbors) {
      ++borders;
      const auto& back = (*plan.layout)[n.subdomain].neighbors;
      CHECK(std::ranges::any_of(back,
                                [&](const balancer::Neighbor& b) { return b.subdomain == s && b.length == n.length; }));
    }
  }
  CHECK(inside > 0);
  CHECK(borders > 40);
}
