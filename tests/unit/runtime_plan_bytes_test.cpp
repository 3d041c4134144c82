#include <doctest/doctest.h>

#include "driftmesh/error.hpp"
#include "runtime/plan_bytes.hpp"
#include "runtime_fixture.hpp"

using namespace driftmesh;
using namespace driftmesh::testing;

TEST_CASE("a plan is the same after a trip through bytes, and damaged bytes are rejected") {
  RunPlan plan = plan_of(ell(), {25, {1e-3, false}, {0, 0.5}, nullptr}, 3, 9, Presplit::kOff);
  plan.work.aggregation = 17;
  plan.max_triangles = 12345;
  const Bytes bytes = plan_to_bytes(plan);
  const RunPlan copy = plan_from_bytes(bytes, 3);
  CHECK(copy.decomposition == plan.decomposition);
  CHECK(copy.owners == plan.owners);
  CHECK(copy.bounds.min_angle == 25);
  CHECK(copy.bounds.plain.area == plan.bounds.plain.area);
  CHECK(!copy.bounds.plain.region_areas);
  CHECK(copy.bounds.region_max_area == plan.bounds.region_max_area);
  CHECK(!copy.presplit);
  CHECK(copy.work.aggregation == 17);
  CHECK(copy.max_triangles == 12345);
  CHECK_THROWS_AS(plan_from_bytes(std::span(bytes).first(bytes.size() - 1), 3), Error);
  Bytes longer = bytes;
  longer.push_back({});
  CHECK_THROWS_AS(plan_from_bytes(longer, 3), Error);
}

TEST_CASE("an input is the same after a trip through bytes") {
  Pslg pslg;
  pslg.points = {{0, 0}, {1, 0}, {0, 1}, {5, 5}};
  pslg.segments = {{0, 1, 1}, {1, 2, 2}, {2, 0, 3}};
  pslg.regions = {{{}, 7, 2}};
  pslg.polygons = {{{{0, 1, 2}, {}}, 0, 3}, {}, {{{2, 1, 0}}, -1, 0}};
  const Bytes bytes = pslg_to_bytes(pslg);
  const Pslg copy = pslg_from_bytes(bytes);
  CHECK(copy.points == pslg.points);
  CHECK(copy.segments == pslg.segments);
  CHECK(copy.regions == pslg.regions);
  CHECK(copy.polygons == pslg.polygons);
  for (std::size_t length = 0; length < bytes.size(); ++length)
    CHECK_THROWS_AS((void)pslg_from_bytes(std::span(bytes).first(length)), Error);
}
