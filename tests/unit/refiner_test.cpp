#include "mesh/refiner.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "driftmesh/error.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "mesh/exceptions.hpp"
#include "small_domains.hpp"

// The refiner as a subdomain uses it: slice by slice, stopped and taken up again, told of points and telling them.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

constexpr auto id = &Triangulation::id;

}  // namespace

TEST_CASE("a mesh can be made in slices, and comes out the same") {
  const Pslg pslg = fan(3, 9);
  QualityBounds bounds;
  bounds.max_area = 1e-4;
  Triangulation whole = triangulate(pslg), sliced = triangulate(pslg);
  CHECK(Refiner(whole, bounds).refine() == Refiner::Status::kDone);
  Refiner refiner(sliced, bounds);
  int slices = 0;
  while (refiner.refine(97) == Refiner::Status::kBudget) ++slices;
  CHECK(slices > 100);
  CHECK(refiner.refine(1) == Refiner::Status::kDone);
  REQUIRE(whole.triangles.size() == sliced.triangles.size());
  for (std::size_t t = 0; t < whole.triangles.size(); ++t)
    REQUIRE(whole.triangles[t].vertex == sliced.triangles[t].vertex);
  for (std::size_t v = 0; v < whole.points.size(); ++v) REQUIRE(whole.points[v] == sliced.points[v]);
}

TEST_CASE("a refiner made from a copy of mesh and state goes on as the first one does") {
  const Pslg pslg = fan(7, 9);
  QualityBounds bounds;
  bounds.max_area = 1e-3;
  for (const std::int64_t before : {0, 1, 5, 40, 300, 1500, 100000}) {
    CAPTURE(before);
    Triangulation mesh = triangulate(pslg);
    prepare_corners(mesh);
    Refiner refiner(mesh, bounds);
    refiner.refine(before);
    Triangulation copy = mesh;
    Refiner again(copy, bounds, refiner.state());
    for (Refiner* r : {&refiner, &again}) {
      CHECK(r->add_split_point(1, 37));
      CHECK(r->refine() == Refiner::Status::kDone);
    }
    CHECK(refiner.counters().free_points == again.counters().free_points);
    CHECK(refiner.counters().encroaching == again.counters().encroaching);
    REQUIRE(mesh.triangles.size() == copy.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      REQUIRE(mesh.triangles[t].vertex == copy.triangles[t].vertex);
  }
}

TEST_CASE("a state that leaves its mesh is refused") {
  Triangulation mesh = triangulate(fan(7, 9));
  const QualityBounds bounds;
  const auto refused = [&](RefinerState state, const std::string& why) {
    CHECK_THROWS_WITH_AS(Refiner(mesh, bounds, std::move(state)), doctest::Contains(why.c_str()), Error);
  };
  const auto triangles = static_cast<TriangleId>(mesh.triangles.size());
  const auto subsegments = static_cast<SubsegmentId>(mesh.subsegments.size());
  CHECK_NOTHROW(Refiner(mesh, bounds, RefinerState{}));
  RefinerState state;
  state.deferred = {triangles};
  refused(state, "deferred");
  state = {};
  state.skinny.add(-1, 5);
  refused(state, "skinny");
  state = {};
  state.sweep = Sweep({0, 0, 0, triangles + 1, 1}, {});
  refused(state, "sweep");
  state.sweep = Sweep({0, 0, 0, 0, 1}, {triangles});
  refused(state, "sweep");
  state = {};
  state.next_segment = subsegments + 1;
  refused(state, "segment");
  state = {};
  state.unsplittable = {subsegments};
  refused(state, "unsplittable");
  state = {};
  state.made = {{-1, 1}};
  refused(state, "split point");
}

TEST_CASE("split points from outside are inserted with their ancestors at any time") {
  QualityBounds bounds;
  bounds.max_area = 1e-3;
  for (const std::int64_t before : {0, 1, 50, 300, 100000}) {
    Triangulation mesh = triangulate(rectangle(2, 1));
    Refiner refiner(mesh, bounds);
    refiner.refine(before);
    const dyadic::Path path = 0b1'0110'1011;
    CHECK(refiner.add_split_point(0, path));
    CHECK(refiner.add_split_point(0, path));  // a duplicate changes nothing
    CHECK(refiner.refine() == Refiner::Status::kDone);
    check_valid(mesh);
    for (dyadic::Path k = path; k >= 1; k = dyadic::parent(k)) {
      const Subsegment& s = mesh.subsegments[id(mesh.descend(0, k))];
      CHECK(s.path == k);
      CHECK(!s.is_leaf());
    }
    const Exceptions exceptions = find_exceptions(mesh, bounds);
    CHECK(exceptions.large.empty());
    CHECK(exceptions.skinny.empty());
  }
}

TEST_CASE("the refiner tells which points it has put on segments, ancestors first, and not what it was told") {
  Triangulation mesh = triangulate(fan(11, 5));
  std::vector<std::vector<dyadic::Path>> known(mesh.roots.size());
  Refiner refiner(mesh, QualityBounds{20, 0.01, {}, nullptr});
  const auto take_in = [&](RootId root, dyadic::Path path) {
    auto& paths = known[id(root)];
    REQUIRE(std::find(paths.begin(), paths.end(), path) == paths.end());
    REQUIRE((path == 1 || std::find(paths.begin(), paths.end(), dyadic::parent(path)) != paths.end()));
    paths.push_back(path);
  };
  for (auto status = Refiner::Status::kBudget; status == Refiner::Status::kBudget;) {
    status = refiner.refine(7);
    for (const SplitPoint<RootId>& p : refiner.take_split_points()) take_in(p.root, p.path);
  }
  CHECK(refiner.take_split_points().empty());
  REQUIRE(std::find(known[0].begin(), known[0].end(), 19) == known[0].end());
  CHECK(refiner.add_split_point(0, 19));
  CHECK(refiner.take_split_points().empty());
  for (const dyadic::Path path : {1, 2, 4, 9, 19})
    if (std::find(known[0].begin(), known[0].end(), path) == known[0].end()) known[0].push_back(path);
  refiner.refine();
  for (const SplitPoint<RootId>& p : refiner.take_split_points()) take_in(p.root, p.path);
  std::size_t inner = 0, told = 0;
  for (const Subsegment& s : mesh.subsegments) inner += !s.is_leaf();
  for (const auto& paths : known) told += paths.size();
  CHECK(inner == told);
}
