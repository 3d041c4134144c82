#include <doctest/doctest.h>

#include "driftmesh/error.hpp"
#include "runtime/plan_bytes.hpp"
#include "runtime_fixture.hpp"

using namespace driftmesh;
using namespace driftmesh::testing;

TEST_CASE("a plan is the same after a trip through bytes, and damaged bytes are rejected") {
  RunPlan plan = plan_of(ell(), {25, 1e-3, {0, 0.5}, nullptr}, 3, 9, Presplit::kOff);
  plan.work.aggregation = 17;
  plan.max_triangles = 12345;
  const Bytes bytes = plan_to_bytes(plan);
  const RunPlan copy = plan_from_bytes(bytes, 3);
  CHECK(copy.decomposition == plan.decomposition);
  CHECK(copy.owners == plan.owners);
  CHECK(copy.bounds.min_angle == 25);
  CHECK(copy.bounds.region_max_area == plan.bounds.region_max_area);
  CHECK(!copy.presplit);
  CHECK(copy.work.aggregation == 17);
  CHECK(copy.max_triangles == 12345);
  CHECK_THROWS_AS(plan_from_bytes(std::span(bytes).first(bytes.size() - 1), 3), Error);
  Bytes longer = bytes;
  longer.push_back({});
  CHECK_THROWS_AS(plan_from_bytes(longer, 3), Error);
}
