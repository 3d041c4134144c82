#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "patch/area.hpp"
#include "unit_squares.hpp"

// The triangles that an area overlaps, against areas of what is left of its rings within each of them.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

double cross(const Point& o, const Point& p, const Point& q) {
  return (p.x - o.x) * (q.y - o.y) - (p.y - o.y) * (q.x - o.x);
}

/// What of a ring, whatever its direction, is left of a line; as Sutherland and Hodgman have it.
std::vector<Point> left_of(const Point& a, const Point& b, const std::vector<Point>& ring) {
  std::vector<Point> left;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point &p = ring[i], &q = ring[(i + 1) % ring.size()];
    const double u = cross(a, b, p), v = cross(a, b, q);
    if (u >= 0) left.push_back(p);
    if ((u > 0 && v < 0) || (u < 0 && v > 0))
      left.push_back({p.x + u / (u - v) * (q.x - p.x), p.y + u / (u - v) * (q.y - p.y)});
  }
  return left;
}

double signed_area_of(const std::vector<Point>& ring) {
  double twice = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) twice += cross({0, 0}, ring[i], ring[(i + 1) % ring.size()]);
  return twice / 2;
}

using Rings = std::vector<std::vector<Point>>;  ///< the outer ring counterclockwise, holes clockwise

double shared_area(const Mesh& mesh, std::size_t t, const Rings& rings) {
  double sum = 0;
  const auto& corners = mesh.triangles[t];
  for (std::vector<Point> ring : rings) {
    for (std::size_t i = 0; i < 3; ++i)
      ring = left_of(mesh.points[static_cast<std::size_t>(corners[i])],
                     mesh.points[static_cast<std::size_t>(corners[(i + 1) % 3])], ring);
    sum += signed_area_of(ring);
  }
  return sum;
}

/// Squares in three regions, one beside the other.
Mesh grid() {
  Mesh mesh = unit_squares(9, 9);
  for (const auto& corners : mesh.triangles) {
    const double x = mesh.points[static_cast<std::size_t>(corners[0])].x;
    mesh.regions.push_back(x < 3 ? 1 : x < 6 ? 2 : 3);
  }
  return mesh;
}

/// A ring around a point, which sees all of it; on halves.
std::vector<Point> star(std::mt19937& random, const Point& center, double most) {
  constexpr Point kDirections[] = {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
  std::vector<Point> ring;
  for (const Point& d : kDirections) {
    const double r = 0.25 * static_cast<double>(1 + random() % static_cast<unsigned>(4 * most));
    ring.push_back({center.x + r * d.x, center.y + r * d.y});
  }
  return ring;
}

void add(Pslg& pslg, const Rings& rings, bool as_polygon) {
  Pslg::Polygon polygon;
  for (const std::vector<Point>& ring : rings) {
    Pslg::Ring corners;
    const auto first = static_cast<std::int32_t>(pslg.points.size()), n = static_cast<std::int32_t>(ring.size());
    for (std::int32_t i = 0; i < n; ++i) {
      pslg.points.push_back(ring[static_cast<std::size_t>(i)]);
      pslg.segments.push_back({first + i, first + (i + 1) % n, 1});
      corners.push_back(first + i);
    }
    polygon.rings.push_back(corners);
  }
  if (as_polygon) pslg.polygons.push_back(polygon);
}

}  // namespace

TEST_CASE("an area has the triangles that share more than a border with it") {
  const Mesh mesh = grid();
  std::size_t all = 0;
  for (unsigned seed = 1; seed <= 150; ++seed) {
    CAPTURE(seed);
    std::mt19937 random(seed);
    std::vector<Rings> areas;
    for (unsigned k = 0; k <= seed % 3; ++k) {
      const Point center{1 + 0.25 * static_cast<double>(random() % 32), 1 + 0.25 * static_cast<double>(random() % 32)};
      Rings rings{star(random, center, 3)};
      if (random() % 2 == 0) {  // a hole within the square around the center
        std::vector<Point> hole;
        for (const Point& p : {Point{0, 1}, Point{1, 0}, Point{0, -1}, Point{-1, 0}})
          hole.push_back({center.x + 0.0625 * p.x, center.y + 0.0625 * p.y});
        rings.push_back(hole);
      }
      areas.push_back(rings);
    }
    const bool as_polygons = seed % 3 != 0 || seed % 2 == 0;  // segments alone know of no areas that overlap
    Pslg pslg;
    for (const Rings& rings : areas) add(pslg, rings, as_polygons);
    const std::vector<bool> inside = patch::triangles_in(mesh, pslg);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const bool expected =
          std::ranges::any_of(areas, [&](const Rings& rings) { return shared_area(mesh, t, rings) > 1e-9; });
      CHECK(inside[t] == expected);
      all += inside[t];
    }
  }
  CHECK(all > 1000);
}

TEST_CASE("what is in a hole is not in the area") {
  const Mesh mesh = grid();
  const auto square = [](double low, double high) {
    return std::vector<Point>{{low, low}, {high, low}, {high, high}, {low, high}};
  };
  Rings rings{square(1, 8), square(2.5, 6)};
  std::ranges::reverse(rings.back());
  Pslg pslg;
  add(pslg, rings, true);
  const std::vector<bool> inside = patch::triangles_in(mesh, pslg);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) CHECK(inside[t] == (shared_area(mesh, t, rings) > 1e-9));
}

TEST_CASE("a box has the triangles that share more than a border with it") {
  const Mesh mesh = grid();
  std::mt19937 random(1);
  for (int k = 0; k < 100; ++k) {
    const auto at = [&] { return -1 + 0.25 * static_cast<double>(random() % 44); };
    const double x = at(), y = at(), width = 0.25 + 0.25 * static_cast<double>(random() % 12);
    const Box box{{x, y}, {x + width, y + 0.5 * width}};
    const Rings ring{{box.low, {box.high.x, box.low.y}, box.high, {box.low.x, box.high.y}}};
    const std::vector<bool> inside = patch::triangles_in(mesh, box);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) CHECK(inside[t] == (shared_area(mesh, t, ring) > 1e-9));
  }
}

TEST_CASE("a region has its own triangles") {
  const Mesh mesh = grid();
  const std::vector<bool> inside = patch::triangles_of_region(mesh, 2);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) CHECK(inside[t] == (mesh.regions[t] == 2));
}
