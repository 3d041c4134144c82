#include <doctest/doctest.h>

#include <cstdint>
#include <string>
#include <utility>

#include "driftmesh/error.hpp"
#include "driftmesh/size_field.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "mesh/refiner.hpp"
#include "small_domains.hpp"

// The state of a refiner, from which another one goes on, and what is wrong with one from elsewhere.

using namespace driftmesh;
using namespace driftmesh::testing;

TEST_CASE("a refiner made from a copy of mesh and state continues identically") {
  const Pslg pslg = fan(7, 9);
  QualityBounds bounds;
  bounds.plain.area = 1e-3;
  for (const std::int64_t before : {0, 1, 5, 40, 300, 1500, 100000}) {
    CAPTURE(before);
    Triangulation mesh = triangulate(pslg);
    prepare_corners(mesh);
    Refiner refiner(mesh, bounds);
    refiner.refine(before);
    Triangulation copy = mesh;
    Refiner again(copy, bounds, refiner.state());
    for (Refiner* r : {&refiner, &again}) {
      CHECK(r->add_split_point(RootId{1}, 37));
      CHECK(r->refine() == Refiner::Status::kDone);
    }
    CHECK(refiner.counters().free_points == again.counters().free_points);
    CHECK(refiner.counters().encroaching == again.counters().encroaching);
    REQUIRE(mesh.triangles.size() == copy.triangles.size());
    for (const TriangleId t : ids_of(mesh.triangles)) REQUIRE(mesh.triangles[t].vertex == copy.triangles[t].vertex);
  }
}

TEST_CASE("one made in the coarse stage continues identically, and the fine stage goes by blocks") {
  QualityBounds bounds;
  bounds.plain.area = 1.0 / 400'000;
  Triangulation mesh = triangulate(rectangle(1, 1));
  Refiner refiner(mesh, bounds);
  refiner.refine(500);
  REQUIRE(refiner.state().stage == RefinerState::Stage::kCoarse);
  Triangulation copy = mesh;
  Refiner again(copy, bounds, refiner.state());
  while (refiner.state().stage == RefinerState::Stage::kCoarse) refiner.refine(100);
  while (again.state().stage == RefinerState::Stage::kCoarse) again.refine(100);
  REQUIRE(mesh.triangles.size() == copy.triangles.size());
  for (const TriangleId t : ids_of(mesh.triangles)) REQUIRE(mesh.triangles[t].vertex == copy.triangles[t].vertex);
  REQUIRE(refiner.state().stage == RefinerState::Stage::kFine);
  const auto [cursor, block_end, given, added, block] = refiner.state().sweep.places();
  CHECK(given > 1000);
  CHECK(block < given / 2);
}

TEST_CASE("a state that refers to parts outside its mesh is rejected") {
  Triangulation mesh = triangulate(fan(7, 9));
  const QualityBounds bounds;
  const auto refused = [&](RefinerState state, const std::string& why) {
    CHECK_THROWS_WITH_AS(Refiner(mesh, bounds, std::move(state)), doctest::Contains(why.c_str()), Error);
  };
  const TriangleId past_triangles = mesh.triangles.next_id();
  const SubsegmentId past_subsegments = mesh.subsegments.next_id();
  CHECK_NOTHROW(Refiner(mesh, bounds, RefinerState{}));
  RefinerState state;
  state.deferred.push_back(past_triangles);
  refused(state, "deferred");
  state = {};
  state.skinny.add(kNone, 5);
  refused(state, "skinny");
  state = {};
  state.sweep = Sweep({0, 0, 0, to_int(past_triangles) + 1, 1}, {});
  refused(state, "sweep");
  GrowingArray<TriangleId> again;
  again.push_back(past_triangles);
  state.sweep = Sweep({0, 0, 0, 0, 1}, again);
  refused(state, "sweep");
  state = {};
  state.next_segment = after(past_subsegments);
  refused(state, "segment");
  state = {};
  state.unsplittable = {past_subsegments};
  refused(state, "unsplittable");
  state = {};
  state.made = {{kNone, 1}};
  refused(state, "split point");
  for (const std::int64_t count : {std::int64_t{-1}, std::int64_t{1} << 60})
    for (std::int64_t RefineCounters::*counter :
         {&RefineCounters::free_points, &RefineCounters::segment_points, &RefineCounters::deleted_points,
          &RefineCounters::encroaching, &RefineCounters::given_up}) {
      state = {};
      state.counters.*counter = count;
      refused(state, "counter");
    }
}

TEST_CASE("a state knows the size at every vertex, and bounds are for the regions that there are") {
  class One final : public SizeField {
   public:
    [[nodiscard]] double edge_length(const Point&) const override { return 0.1; }
  };
  const One size;
  Pslg pslg = rectangle(2, 1);
  pslg.points.insert(pslg.points.end(), {{1, 0}, {1, 1}});
  pslg.segments = {{0, 4, 1}, {4, 1, 1}, {1, 2, 1}, {2, 5, 1}, {5, 3, 1}, {3, 0, 1}, {4, 5, 1}};
  pslg.regions = {{{0.5, 0.5}, 1, 0.25}, {{1.5, 0.5}, 2, 0.5}};
  Triangulation mesh = triangulate(pslg);
  QualityBounds bounds;
  bounds.region_max_area = areas_by_region(pslg);
  bounds.size = &size;
  REQUIRE(SizeBounds(bounds).regions() > 1);
  RefinerState state = RefinerState::at_start(mesh, bounds);
  CHECK_NOTHROW(Refiner(mesh, bounds, state));
  RefinerState unknown = state;
  unknown.size.resize(mesh.points.size() - 1, 0.1);
  CHECK_THROWS_WITH_AS(Refiner(mesh, bounds, unknown), doctest::Contains("size"), Error);
  const std::size_t labels = SizeBounds(bounds).regions();
  mesh.region[TriangleId{0}] = static_cast<std::uint16_t>(labels);
  CHECK_THROWS_WITH_AS(Refiner(mesh, bounds, state), doctest::Contains("region"), Error);
  mesh.region[TriangleId{0}] = static_cast<std::uint16_t>(labels - 1);
  CHECK_NOTHROW(Refiner(mesh, bounds, state));
}
