#include <doctest/doctest.h>

#include <string>
#include <tuple>

#include "balancer/policies/policy_factory.hpp"
#include "driftmesh/error.hpp"
#include "runtime/plan_bytes.hpp"
#include "runtime_fixture.hpp"

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

// Member by member, taken apart so that one more does not compile before it is compared. What no other rank is sent is
// named, and not compared.

void check_same(const balancer::ControllerOptions& a, const balancer::ControllerOptions& b) {
  const auto& [alook, agap, ainterval, achange, arefusals, aahead, aoverhead, areference, awork, acost, aworth] = a;
  const auto& [blook, bgap, binterval, bchange, brefusals, bahead, boverhead, breference, bwork, bcost, bworth] = b;
  CHECK(std::tie(alook, agap, ainterval, achange, arefusals, aahead, aoverhead, areference, awork) ==
        std::tie(blook, bgap, binterval, bchange, brefusals, bahead, boverhead, breference, bwork));
  const auto& [alatency, abandwidth, apack] = acost;
  const auto& [blatency, bbandwidth, bpack] = bcost;
  CHECK(std::tie(alatency, abandwidth, apack) == std::tie(blatency, bbandwidth, bpack));
  const auto& [again, aseconds, aslack] = aworth;
  const auto& [bgain, bseconds, bslack] = bworth;
  CHECK(std::tie(again, aseconds, aslack) == std::tie(bgain, bseconds, bslack));
}

void check_same(const RunPlan& a, const RunPlan& b) {
  const auto& [aowners, awork, amax, abalancing, alayout, apolicy] = static_cast<const LoopPlan&>(a);
  const auto& [bowners, bwork, bmax, bbalancing, blayout, bpolicy] = static_cast<const LoopPlan&>(b);
  CHECK(aowners == bowners);
  CHECK(amax == bmax);
  const auto& [aaggregation, aslice, aorder, adecoupled, asleep, athreads] = awork;
  const auto& [baggregation, bslice, border, bdecoupled, bsleep, bthreads] = bwork;
  CHECK(std::tie(aaggregation, aslice, aorder, adecoupled, asleep, athreads) ==
        std::tie(baggregation, bslice, border, bdecoupled, bsleep, bthreads));
  const auto& [aname, aparameters, aoptions] = abalancing;
  const auto& [bname, bparameters, boptions] = bbalancing;
  CHECK(aname == bname);
  CHECK(aparameters == bparameters);
  check_same(aoptions, boptions);
  CHECK(a.decomposition == b.decomposition);
  CHECK(a.presplit == b.presplit);
  const auto& [aangle, aplain, aregions, asize, astep, arules] = a.bounds;
  const auto& [bangle, bplain, bregions, bsize, bstep, brules] = b.bounds;
  CHECK(aangle == bangle);
  CHECK(aregions == bregions);
  const auto& [aarea, aregion_areas] = aplain;
  const auto& [barea, bregion_areas] = bplain;
  CHECK(std::tie(aarea, aregion_areas) == std::tie(barea, bregion_areas));
}

}  // namespace

TEST_CASE("a plan is the same after a trip through bytes, and damaged bytes are rejected") {
  Pslg domain = ell();
  for (const Point& p : {Point{0.7, 0.8}, Point{0.1, 1.2}, Point{1.7, 0.2}, Point{1.8, 0.9}, Point{0.15, 1.85}})
    domain.points.push_back(p);  // on no segment, so that subdomains list those that cuts avoid
  RunPlan plan = plan_of(domain, {25, {1e-3, false}, {0, 0.5}, nullptr}, 3, 9, Presplit::kOn);
  REQUIRE(!plan.decomposition.point_list.empty());
  plan.work = {
      .aggregation = 17, .slice = 77, .order = WorkOrder::kBacklog, .decoupled = true, .sleep = true, .threads = 5};
  plan.max_triangles = 12345;
  plan.balancing.policy = "stealing";
  plan.balancing.parameters = {{"low-water", "0.5"}};
  plan.balancing.options.look = 0.125;
  plan.balancing.options.refusals = 3;
  plan.balancing.options.worth.seconds = 0.25;
  plan.balancing.options.cost.latency = 0.5;
  const Bytes bytes = plan_to_bytes(plan);
  std::string made;
  const balancer::PolicyMaker maker = [&](const std::string& name, const balancer::Parameters::Values& parameters) {
    made = name + " " + parameters.at("low-water");
    return balancer::make_policy(name, parameters);
  };
  const RunPlan copy = plan_from_bytes(bytes, 3, maker);
  CHECK(made == "stealing 0.5");
  CHECK(copy.policy != nullptr);
  REQUIRE(copy.layout != nullptr);
  CHECK(copy.layout->ranks == 3);
  check_same(copy, plan);
  CHECK_THROWS_AS(plan_from_bytes(std::span(bytes).first(bytes.size() - 1), 3, maker), Error);
  Bytes longer = bytes;
  longer.push_back({});
  CHECK_THROWS_AS(plan_from_bytes(longer, 3, maker), Error);
}

TEST_CASE("an input is the same after a trip through bytes") {
  Pslg pslg;
  pslg.points = {{0, 0}, {1, 0}, {0, 1}, {5, 5}};
  pslg.point_markers = {3, 0, 9, 1};
  pslg.attributes = {0.5, 1, 2, 3, 4, 5, 6, 7};
  pslg.attributes_per_point = 2;
  pslg.holes = {{0.25, 0.25}};
  pslg.first_number = 0;
  pslg.names.markers = {{2, "inlet"}};
  pslg.names.regions = {{7, "sea"}};
  pslg.segments = {{0, 1, 1}, {1, 2, 2}, {2, 0, 3}};
  pslg.regions = {{{}, 7, 2}};
  pslg.polygons = {{{{0, 1, 2}, {}}, 0, 3}, {}, {{{2, 1, 0}}, -1, 0}};
  const Bytes bytes = pslg_to_bytes(pslg);
  const Pslg copy = pslg_from_bytes(bytes);
  CHECK(copy.points == pslg.points);
  CHECK(copy.point_markers == pslg.point_markers);
  CHECK(copy.attributes == pslg.attributes);
  CHECK(copy.attributes_per_point == pslg.attributes_per_point);
  CHECK(copy.segments == pslg.segments);
  CHECK(copy.holes == pslg.holes);
  CHECK(copy.regions == pslg.regions);
  CHECK(copy.first_number == pslg.first_number);
  CHECK(copy.names == pslg.names);
  CHECK(copy.polygons == pslg.polygons);
  for (std::size_t length = 0; length < bytes.size(); ++length)
    CHECK_THROWS_AS((void)pslg_from_bytes(std::span(bytes).first(length)), Error);
}
