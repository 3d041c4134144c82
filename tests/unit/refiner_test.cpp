#include "mesh/refiner.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "driftmesh/error.hpp"
#include "driftmesh/generate.hpp"
#include "driftmesh/size_field.hpp"
#include "geometry/predicates.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "mesh/exceptions.hpp"
#include "small_domains.hpp"

// The refiner as a subdomain uses it: in slices, stopped and resumed, with split points received and reported.

using namespace driftmesh;
using namespace driftmesh::testing;

TEST_CASE("a mesh made in slices is the same") {
  const Pslg pslg = fan(3, 9);
  QualityBounds bounds;
  bounds.plain.area = 1e-4;
  Triangulation whole = triangulate(pslg), sliced = triangulate(pslg);
  CHECK(Refiner(whole, bounds).refine() == Refiner::Status::kDone);
  Refiner refiner(sliced, bounds);
  int slices = 0;
  while (refiner.refine(97) == Refiner::Status::kBudget) ++slices;
  CHECK(slices > 100);
  CHECK(refiner.refine(1) == Refiner::Status::kDone);
  REQUIRE(whole.triangles.size() == sliced.triangles.size());
  for (const TriangleId t : ids_of(whole.triangles)) REQUIRE(whole.triangles[t].vertex == sliced.triangles[t].vertex);
  for (const VertexId v : ids_of(whole.points)) REQUIRE(whole.points[v] == sliced.points[v]);
}

TEST_CASE("refinement leaves a sound triangulation, stopped or not, with small angles and without") {
  for (const int wedges : {0, 3, 20, 40})
    for (const double angle : {0.0, 20.0, 33.0})
      for (const std::int64_t insertions : {100, 100'000}) {
        CAPTURE(wedges);
        CAPTURE(angle);
        CAPTURE(insertions);
        Triangulation mesh = triangulate(fan(5, wedges));
        prepare_corners(mesh, {angle, false});
        QualityBounds bounds;
        bounds.min_angle = angle;
        bounds.plain.area = 1e-3;
        const Refiner::Status status = Refiner(mesh, bounds).refine(insertions);
        CHECK((status == Refiner::Status::kDone) == (insertions > 100));
        check_valid(mesh);
      }
}

TEST_CASE(
    "each vertex has the length that the field asks for there, in every stage, in any slot, however many there are") {
  class Field final : public SizeField {
   public:
    explicit Field(double least) : least_(least) {}
    [[nodiscard]] double edge_length(const Point& p) const override { return least_ * (1 + 2 * p.x + p.y); }

   private:
    double least_;
  };
  // Enough for the coarse stage and 100,000 vertices; and few, told of points that delete others.
  for (const double least : {0.0015, 0.05}) {
    const Field field(least);
    Pslg pslg;
    pslg.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    pslg.segments = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 0, 1}};
    Triangulation mesh = triangulate(pslg);
    prepare_corners(mesh);
    QualityBounds bounds;
    bounds.size = &field;
    Refiner refiner(mesh, bounds);
    std::vector<RefinerState::Stage> stages;
    int deleted = 0;
    for (int slice = 0; slice < 200; ++slice) {
      const Refiner::Status status = refiner.refine(least < 0.01 ? 20'000 : 20);
      stages.push_back(refiner.state().stage);
      std::size_t wrong = 0;
      for (const VertexId v : ids_of(mesh.points))
        if (mesh.origin[v] != kDeleted) wrong += refiner.state().size[v] != field.edge_length(mesh.points[v]);
      REQUIRE(wrong == 0);
      deleted += !mesh.free_vertices.empty();
      if (status != Refiner::Status::kDone) continue;
      if (least < 0.01 || slice > 190) break;
      refiner.add_split_point(RootId{slice % 4}, static_cast<dyadic::Path>(1 + slice * 37 % 255));
    }
    using Stage = RefinerState::Stage;
    const auto saw = [&](Stage stage) { return std::ranges::find(stages, stage) != stages.end(); };
    CHECK(saw(Stage::kDone));
    if (least > 0.01) continue;
    CHECK(mesh.live_vertices() > 120'000);
    CHECK(saw(RefinerState::Stage::kFine));
    // Few points make the coarse mesh: the first slice goes through it.
    Triangulation coarse = triangulate(pslg);
    prepare_corners(coarse);
    Refiner begins(coarse, bounds);
    begins.refine(20);
    CHECK(begins.state().stage == RefinerState::Stage::kCoarse);
  }
}

TEST_CASE("external split points are inserted with their ancestors at any time") {
  QualityBounds bounds;
  bounds.plain.area = 1e-3;
  for (const std::int64_t before : {0, 1, 50, 300, 100000}) {
    Triangulation mesh = triangulate(rectangle(2, 1));
    Refiner refiner(mesh, bounds);
    refiner.refine(before);
    const dyadic::Path path = 0b1'0110'1011;
    CHECK(refiner.add_split_point(RootId{0}, path));
    CHECK(refiner.add_split_point(RootId{0}, path));  // a duplicate changes nothing
    CHECK(refiner.refine() == Refiner::Status::kDone);
    check_valid(mesh);
    for (dyadic::Path k = path; k >= 1; k = dyadic::parent(k)) {
      const Subsegment& s = mesh.subsegments[mesh.descend(RootId{0}, k)];
      CHECK(s.path == k);
      CHECK(!s.is_leaf());
    }
    const Exceptions exceptions = find_exceptions(mesh, bounds);
    CHECK(exceptions.large.empty());
    CHECK(exceptions.skinny.empty());
  }
}

TEST_CASE("the refiner reports the points it has put on segments, ancestors first, but not external ones") {
  Triangulation mesh = triangulate(fan(11, 5));
  IdVector<RootId, std::vector<dyadic::Path>> known(mesh.roots.size());
  const RootId first{0};
  Refiner refiner(mesh, QualityBounds{20, {0.01}, {}, nullptr});
  const auto take_in = [&](RootId root, dyadic::Path path) {
    auto& paths = known[root];
    REQUIRE(std::find(paths.begin(), paths.end(), path) == paths.end());
    REQUIRE((path == 1 || std::find(paths.begin(), paths.end(), dyadic::parent(path)) != paths.end()));
    paths.push_back(path);
  };
  for (auto status = Refiner::Status::kBudget; status == Refiner::Status::kBudget;) {
    status = refiner.refine(7);
    for (const SplitPoint<RootId>& p : refiner.take_split_points()) take_in(p.root, p.path);
  }
  CHECK(refiner.take_split_points().empty());
  REQUIRE(std::find(known[first].begin(), known[first].end(), 19) == known[first].end());
  CHECK(refiner.add_split_point(first, 19));
  CHECK(refiner.take_split_points().empty());
  for (const dyadic::Path path : {1, 2, 4, 9, 19})
    if (std::find(known[first].begin(), known[first].end(), path) == known[first].end()) known[first].push_back(path);
  refiner.refine();
  for (const SplitPoint<RootId>& p : refiner.take_split_points()) take_in(p.root, p.path);
  std::size_t inner = 0, told = 0;
  for (const Subsegment& s : mesh.subsegments) inner += !s.is_leaf();
  for (const auto& paths : known) told += paths.size();
  CHECK(inner == told);
}

TEST_CASE("without bounds the constrained Delaunay triangulation stays as it is") {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    CAPTURE(seed);
    // Many segments see a point close by.
    const Pslg pslg = generate_random_points({.points = 300, .segments = 60, .seed = seed});
    Triangulation mesh = triangulate(pslg);
    const std::size_t triangles = mesh.live_triangles();
    QualityBounds bounds;
    bounds.min_angle = 0;
    prepare_corners(mesh, {bounds.min_angle, false});
    Refiner refiner(mesh, bounds);
    CHECK(refiner.refine() == Refiner::Status::kDone);
    CHECK(refiner.counters().segment_points == 0);
    CHECK(mesh.live_triangles() == triangles);
  }
}

TEST_CASE("a mesh that is surely small begins without a forecast that asks its size field") {
  class Counted final : public SizeField {
   public:
    explicit Counted(double least) : least_(least) {}
    [[nodiscard]] double edge_length(const Point& p) const override {
      ++asked;
      return 0.05 + 0.5 * std::hypot(p.x, p.y);
    }
    [[nodiscard]] double least() const override { return least_; }
    mutable std::int64_t asked = 0;

   private:
    double least_;
  };
  const auto asked_before_first_point = [](double least) {
    const Counted size(least);
    Triangulation mesh = triangulate(rectangle(2, 1));
    QualityBounds bounds;
    bounds.size = &size;
    Refiner refiner(mesh, bounds);
    refiner.refine(1);
    return size.asked;
  };
  constexpr std::int64_t kAFew = 20;  // for corners, a centroid or two and the point itself
  CHECK(asked_before_first_point(0.05) < kAFew);
  CHECK(asked_before_first_point(0) > 2 * kAFew);  // nobody knows how fine it gets
}

namespace {

/// Fans of segments, prepared and refined by the rules.
Triangulation refined_fan(int wedges, double angle, const InsertionRules& rules) {
  Triangulation mesh = triangulate(fan(static_cast<unsigned>(wedges) + 7, wedges));
  prepare_corners(mesh, {angle, false, rules});
  QualityBounds bounds{.min_angle = angle, .rules = rules};
  bounds.plain.area = 0.01;
  Refiner(mesh, bounds).refine();
  return mesh;
}

/// Whether no apex beyond a constrained edge lies inside the circumcircle of the triangle before it.
bool is_delaunay_across_segments(const Triangulation& mesh) {
  return std::ranges::all_of(mesh.subsegments, [&](const Subsegment& s) {
    if (!s.is_leaf() || s.half[0] == kNone || s.half[1] == kNone) return true;
    const TriangleId t = triangle_of(s.half[0]);
    return incircle(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2), mesh.points[mesh.apex(s.half[1])]) <= 0;
  });
}

}  // namespace

TEST_CASE("rules of insertion keep segments whole and areas bounded") {
  using Split = InsertionRules::Split;
  for (const int wedges : {0, 3, 20})
    for (const double angle : {0.0, 20.0, 33.0})
      for (const Split split : {Split::kInside, Split::kNowhere}) {
        CAPTURE(wedges);
        CAPTURE(angle);
        const Triangulation mesh = refined_fan(wedges, angle, {.split = split});
        check_valid(mesh);
        for (const TriangleId t : ids_of(mesh.triangles))
          if (mesh.triangles[t].alive())
            CHECK(signed_area(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)) <= 0.01);
        std::size_t boundary = 0, leaves = 0;
        for (const Subsegment& s : mesh.subsegments) {
          leaves += s.is_leaf() ? 1 : 0;
          boundary += s.is_leaf() && (s.half[0] == kNone || s.half[1] == kNone) ? 1 : 0;
        }
        CHECK(boundary == 4);
        if (split == Split::kNowhere) CHECK(leaves == 4U + static_cast<unsigned>(wedges));
      }
}

TEST_CASE("conforming meshes are Delaunay across segments, at small angles and without bounds, too") {
  bool others_are = true;
  for (const int wedges : {2, 3, 8, 20, 40})
    for (const double angle : {0.0, 20.0, 33.0}) {
      CAPTURE(wedges);
      CAPTURE(angle);
      const Triangulation mesh = refined_fan(wedges, angle, {.conforming = true});
      check_valid(mesh);
      CHECK(is_delaunay_across_segments(mesh));
      CHECK(mesh.live_triangles() < 100'000);
      others_are = others_are && is_delaunay_across_segments(refined_fan(wedges, angle, {}));
    }
  CHECK(!others_are);
}

TEST_CASE("refinement ends at a number of points") {
  for (const std::int64_t most : {0, 1, 10, 100}) {
    Triangulation mesh = triangulate(rectangle(2, 1));
    QualityBounds bounds{.rules = {.most_points = most}};
    bounds.plain.area = 1e-4;
    CHECK(Refiner(mesh, bounds).refine() == Refiner::Status::kFull);
    CHECK(static_cast<std::int64_t>(mesh.live_vertices()) == 4 + most);
  }
}

TEST_CASE("counters add up to the points there are, after each slice") {
  class Ring final : public SizeField {  // sharp enough for a coarse stage, and for vertices to be deleted
   public:
    [[nodiscard]] double edge_length(const Point& p) const override {
      return 0.004 + 0.3 * std::abs(std::hypot(p.x, p.y) - 0.5);
    }
  };
  const Ring ring;
  RefineCounters sum;
  bool deferred = false;
  for (const int wedges : {0, 3, 20})
    for (const bool sized : {false, true}) {
      CAPTURE(wedges);
      CAPTURE(sized);
      Triangulation mesh = triangulate(fan(11, wedges));
      prepare_corners(mesh, {20, false});
      const auto before = static_cast<std::int64_t>(mesh.live_vertices());
      QualityBounds bounds;
      bounds.plain.area = 1e-3;
      if (sized) bounds.size = &ring;
      Refiner refiner(mesh, bounds);
      const auto agree = [&] {
        const RefineCounters& c = refiner.counters();
        return static_cast<std::int64_t>(mesh.live_vertices()) ==
               before + c.free_points + c.segment_points - c.deleted_points;
      };
      while (refiner.refine(97) == Refiner::Status::kBudget) {
        REQUIRE(agree());
        deferred = deferred || !refiner.state().deferred.empty();
      }
      CHECK(agree());
      CHECK(refiner.state().deferred.empty());
      const RefineCounters& c = refiner.counters();
      sum.free_points += c.free_points, sum.segment_points += c.segment_points;
      sum.deleted_points += c.deleted_points, sum.encroaching += c.encroaching;
      CHECK(c.given_up == 0);
    }
  CHECK(deferred);
  for (const std::int64_t count : {sum.free_points, sum.segment_points, sum.deleted_points, sum.encroaching})
    CHECK(count > 0);
}

TEST_CASE("where coordinates are too coarse for another point, triangles are given up, counted, and not tried again") {
  constexpr double kFar = 0x1p52;  // numbers are 1 apart there
  std::mt19937 random(1);
  std::size_t unsplittable = 0;
  for (int drawn = 0; drawn < 50; ++drawn) {
    CAPTURE(drawn);
    Pslg pslg;
    for (int i = 0; i < 3; ++i)
      pslg.points.push_back({kFar + static_cast<double>(random() % 7), kFar + static_cast<double>(random() % 7)});
    pslg.segments = {{0, 1, 1}, {1, 2, 1}, {2, 0, 1}};
    if (orient2d(pslg.points[0], pslg.points[1], pslg.points[2]) == 0) continue;
    Triangulation mesh = triangulate(pslg);
    QualityBounds bounds;
    bounds.plain.area = 0.1;
    Refiner refiner(mesh, bounds);
    CHECK(refiner.refine(100'000) == Refiner::Status::kDone);
    CHECK(refiner.counters().given_up > 0);
    unsplittable += refiner.state().unsplittable.size();
    check_valid(mesh);
  }
  CHECK(unsplittable > 0);
}

TEST_CASE("a mesh has at most one triangle more than its limit") {
  for (std::int64_t most = 3; most < 200; ++most) {
    Triangulation mesh = triangulate(fan(3, 5));
    if (static_cast<std::int64_t>(mesh.live_triangles()) >= most) continue;
    QualityBounds bounds;
    bounds.plain.area = 1e-3;
    Refiner refiner(mesh, bounds);
    refiner.limit_triangles(most);
    CHECK(refiner.refine() == Refiner::Status::kFull);
    CHECK(static_cast<std::int64_t>(mesh.live_triangles()) <= most + 1);
  }
}
