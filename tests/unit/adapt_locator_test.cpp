#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "adapt/linear_lengths.hpp"
#include "adapt/locator.hpp"
#include "adapt/slopes.hpp"
#include "geometry/predicates.hpp"
#include "geometry/segment_geometry.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/cdt.hpp"
#include "mesh/refiner.hpp"
#include "support/random.hpp"
#include "support/rings.hpp"

// Where points are in a triangulation, and how lengths change there, against a look at all triangles.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

/// A comb: between its teeth walks from one to the next end at the boundary.
Triangulation comb(double area) {
  Pslg pslg;
  std::vector<Point> ring{{0, 0}, {9, 0}};
  for (int tooth = 4; tooth >= 0; --tooth) {
    const double left = 2.0 * tooth;
    ring.insert(ring.end(), {{left + 1, 6}, {left, 6}});
    if (tooth > 0) ring.insert(ring.end(), {{left, 1}, {left - 1, 1}});
  }
  add_ring(pslg, ring);
  Triangulation mesh = triangulate(pslg);
  QualityBounds bounds;
  bounds.plain.area = area;
  Refiner(mesh, bounds).refine();
  return mesh;
}

CornerPoints corners_of(const Triangulation& mesh, TriangleId t) {
  return {mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)};
}

/// Whether it has the point inside or on its border.
bool holds(const CornerPoints& t, const Point& p) {
  return orient2d(t[0], t[1], p) >= 0 && orient2d(t[1], t[2], p) >= 0 && orient2d(t[2], t[0], p) >= 0;
}

bool lies_inside(const Triangulation& mesh, const Point& p) {
  return std::ranges::any_of(ids_of(mesh.triangles),
                             [&](TriangleId t) { return mesh.triangles[t].alive() && holds(corners_of(mesh, t), p); });
}

double distance_to_boundary(const Triangulation& mesh, const Point& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const TriangleId t : ids_of(mesh.triangles))
    for (int i = 0; mesh.triangles[t].alive() && i < 3; ++i)
      if (mesh.across(half_edge(t, i)) == kNone)
        least = std::min(least, squared_distance_to_segment(p, mesh.corner(t, next(i)), mesh.corner(t, previous(i))));
  return std::sqrt(least);
}

Point at(const Triangulation& mesh, const adapt::Locator::Place& place) {
  Point p{0, 0};
  for (int i = 0; i < 3; ++i) {
    p.x += place.weight[i] * mesh.corner(place.triangle, i).x;
    p.y += place.weight[i] * mesh.corner(place.triangle, i).y;
  }
  return p;
}

double apart(const Point& a, const Point& b) {
  return std::sqrt(squared_distance(a, b));
}

}  // namespace

TEST_CASE("points in a comb are found in whatever order they come, and those outside at the nearest boundary") {
  constexpr double kRounding = 1e-12;
  const Triangulation mesh = comb(0.05);
  Random random(1);
  const adapt::Locator locator(mesh);
  int inside = 0, outside = 0;
  for (int i = 0; i < 4000; ++i) {
    const Point p{uniform(random, -2, 11), uniform(random, -2, 8)};
    CAPTURE(p.x);
    CAPTURE(p.y);
    const adapt::Locator::Place place = locator.locate(p);
    const bool is_inside = lies_inside(mesh, p);
    CHECK(place.beyond != is_inside);
    ++(is_inside ? inside : outside);
    CHECK(apart(at(mesh, place), p) ==
          doctest::Approx(is_inside ? 0 : distance_to_boundary(mesh, p)).epsilon(1e-9).scale(1));
    if (is_inside) CHECK(apart(at(mesh, place), p) < kRounding);
    CHECK(adapt::Locator(mesh).locate(p).triangle == place.triangle);  // by the point alone
  }
  CHECK(inside > 500);
  CHECK(outside > 500);
}

TEST_CASE("a vertex is found as one, also at the boundary") {
  const Triangulation mesh = comb(0.2);
  const adapt::Locator locator(mesh);
  for (const VertexId v : ids_of(mesh.points)) {
    if (mesh.origin[v] == kDeleted) continue;
    const adapt::Locator::Place place = locator.locate(mesh.points[v]);
    REQUIRE(place.is_vertex());
    CHECK(mesh.triangles[place.triangle].vertex[place.corner] == v);
    CHECK(!place.beyond);
  }
}

TEST_CASE("slopes in a box are at least those of the triangles there, and less than all where others are steep") {
  const Triangulation mesh = comb(0.02);
  Random random(1);
  IdVector<TriangleId, double> slope(mesh.triangles.size(), 0);
  for (const TriangleId t : ids_of(mesh.triangles))
    slope[t] = centroid(corners_of(mesh, t)).x > 8 ? 5 : uniform(random, 0, 1);
  const adapt::Slopes slopes(mesh, slope);
  CHECK(slopes.most() == 5);
  int lower = 0;
  for (int i = 0; i < 500; ++i) {
    Box box;
    const Point low{uniform(random, 0, 9), uniform(random, 0, 6)};
    box.extend(low);
    box.extend(Point{low.x + uniform(random, 0, 0.5), low.y + uniform(random, 0, 0.5)});
    double most = 0;
    for (const TriangleId t : ids_of(mesh.triangles))
      if (mesh.triangles[t].alive() && Box::of(corners_of(mesh, t)).overlaps(box)) most = std::max(most, slope[t]);
    CHECK(slopes.most_in(box) >= most);
    CHECK(slopes.most_in(box) <= 5);
    lower += slopes.most_in(box) <= 1 ? 1 : 0;
  }
  CHECK(lower > 50);
  Box all, beside;
  all.extend(Point{0, 0});
  all.extend(Point{9, 6});
  CHECK(slopes.most_in(all) == 5);
  beside.extend(Point{1.45, 4});  // between two teeth
  beside.extend(Point{1.55, 4.1});
  CHECK(slopes.most_in(beside) == 5);
}

TEST_CASE("lengths fall below another one where some point of a triangle has one that is much shorter") {
  const Triangulation mesh = comb(0.1);
  Random random(3);
  adapt::Lengths lengths;
  for (VertexId v{0}; to_index(v) < mesh.points.size(); v = static_cast<VertexId>(to_int(v) + 1))
    lengths.push_back(mesh.points[v].x < 4 ? 1 : uniform(random, 0.5, 2));
  const adapt::LinearLengths field(mesh, lengths);
  int below = 0, not_below = 0, flat = 0;
  for (int i = 0; i < 1000; ++i) {
    const Point middle{uniform(random, 1, 8), uniform(random, 0.45, 0.55)};
    CornerPoints triangle;
    for (Point& p : triangle) p = {middle.x + uniform(random, -0.9, 0.9), middle.y + uniform(random, -0.4, 0.4)};
    if (!(signed_area(triangle[0], triangle[1], triangle[2]) > 1e-3)) continue;
    double least = std::numeric_limits<double>::infinity(), at_corners = least;
    constexpr int kSteps = 60;
    for (int a = 0; a <= kSteps; ++a)
      for (int b = 0; a + b <= kSteps; ++b) {
        const double u = 1.0 * a / kSteps, v = 1.0 * b / kSteps, w = 1 - u - v;
        least = std::min(least, field.edge_length({u * triangle[0].x + v * triangle[1].x + w * triangle[2].x,
                                                   u * triangle[0].y + v * triangle[1].y + w * triangle[2].y}));
      }
    for (const Point& p : triangle) at_corners = std::min(at_corners, field.edge_length(p));
    CHECK(field.least_between(triangle, at_corners) <= least);
    const double length = uniform(random, 0.8, 1.6) * (i % 2 == 0 ? least : at_corners);
    if (length > 1.001 * adapt::kBetween * least && length < adapt::kBetween * at_corners) {
      CHECK(field.falls_below(triangle, length));
      ++below;
    }
    if (length < 0.93 * adapt::kBetween * least) {  // least may be a little less than what was looked at
      CHECK(!field.falls_below(triangle, length));
      ++not_below;
    }
    if (middle.x < 3 && field.least_between(triangle, 1) == 1) ++flat;  // however steep others are
  }
  CHECK(below > 50);
  CHECK(not_below > 100);
  CHECK(flat > 50);
}
