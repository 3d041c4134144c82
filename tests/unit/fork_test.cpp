#include "decompose/fork.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "decompose/bridges.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "support/separator_room_oracle.hpp"

// Three separators that meet inside a piece.

using namespace driftmesh;

namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// The outline of a domain with these corners, counterclockwise.
Outline outline_of(const std::vector<Point>& corners, double spacing, double angle) {
  Pslg pslg;
  pslg.points = corners;
  const auto count = static_cast<std::int32_t>(corners.size());
  for (std::int32_t i = 0; i < count; ++i) pslg.segments.push_back({i, (i + 1) % count, 1});
  Triangulation mesh = triangulate(pslg);
  prepare_corners(mesh);
  const PlanarMap map = connected_walls(mesh, 10, angle);
  SideId inside = kNone;
  for (const SideId h : ids_of(map.sides))
    if (map.side(h).in_domain()) inside = h;
  Outline outline;
  read_loop(map, inside, outline.loop);
  place_stations(map, spacing, angle, outline);
  return outline;
}

double angle_between(const Point& center, const Point& a, const Point& b) {
  const double ax = a.x - center.x, ay = a.y - center.y, bx = b.x - center.x, by = b.y - center.y;
  return std::atan2(std::fabs(ax * by - ay * bx), ax * bx + ay * by) / kDegree;
}

}  // namespace

TEST_CASE("a triangle with equal sides is cut from its middle to the middle of each side") {
  const double height = std::sqrt(3.0);
  const std::optional<Fork> fork =
      find_fork(outline_of({{0, 0}, {2, 0}, {1, height}}, 0.1, 61 * kDegree), 61 * kDegree);
  REQUIRE(fork);
  CHECK(std::hypot(fork->center.x - 1, fork->center.y - height / 3) < 1e-12);
  for (const Outline::Station& end : fork->ends)
    CHECK(std::hypot(end.at.x - fork->center.x, end.at.y - fork->center.y) < 1.02 * height / 3);
}

TEST_CASE("a fork keeps the angle, at its center and at the border") {
  const std::vector<Point> corners = {{0, 0}, {3, 0}, {3.2, 1}, {1, 1.6}, {-0.3, 0.8}};
  for (const auto& [least, at_border] : {std::pair(30.0, 30.0), std::pair(61.2, 61.2), std::pair(118.0, 40.0)}) {
    CAPTURE(least);
    const std::optional<Fork> fork = find_fork(outline_of(corners, 0.1, at_border * kDegree), least * kDegree);
    REQUIRE(fork);
    for (std::size_t k = 0; k < 3; ++k) {
      const Outline::Station &end = fork->ends[k], &next = fork->ends[(k + 1) % 3];
      CHECK(angle_between(fork->center, end.at, next.at) >= least - 1e-9);
      CHECK(Outline::allows(end, fork->center.x - end.at.x, fork->center.y - end.at.y));
    }
  }
}

TEST_CASE("a fork ends on three walls, and its parts are about even") {
  for (const double width : {1.0, 2.0, 4.0}) {
    CAPTURE(width);
    const std::optional<Fork> fork =
        find_fork(outline_of({{0, 0}, {width, 0}, {width, 1}, {0, 1}}, 0.05, 40 * kDegree), 40 * kDegree);
    REQUIRE(fork);
    std::array<double, 3> turn{};  // of the ends, from the first one on
    std::array<int, 3> points{};   // of a grid, in each part
    const auto direction = [&](const Point& p) {
      const Point &first = fork->ends[0].at, &c = fork->center;
      const double angle = std::atan2(p.y - c.y, p.x - c.x) - std::atan2(first.y - c.y, first.x - c.x);
      return angle < 0 ? angle + 2 * std::numbers::pi : angle;
    };
    for (std::size_t k = 0; k < 3; ++k) {
      turn[k] = direction(fork->ends[k].at);
      CHECK(PlanarMap::wall_of(fork->ends[k].side) != PlanarMap::wall_of(fork->ends[(k + 1) % 3].side));
    }
    REQUIRE(turn[1] < turn[2]);
    for (int i = 0; i < 100; ++i)
      for (int j = 0; j < 100; ++j) {
        const double at = direction({width * (i + 0.5) / 100, (j + 0.5) / 100});
        ++points[at < turn[1] ? 0 : at < turn[2] ? 1 : 2];
      }
    for (const int count : points) {
      CHECK(count > 2200);
      CHECK(count < 4500);
    }
  }
}

TEST_CASE("what a fork does not meet keeps away from it") {
  std::mt19937_64 random(1);
  const auto unit = [&] { return std::uniform_real_distribution<double>(0, 1)(random); };
  int forks = 0;
  for (int i = 0; i < 300; ++i) {
    CAPTURE(i);
    // A polygon with a narrow spike in each side, which points about at the middle.
    std::vector<Point> corners;
    const int sides = 3 + static_cast<int>(random() % 3);
    for (int k = 0; k < sides; ++k) {
      const auto corner = [&](int n) {
        return Point{std::cos(2 * std::numbers::pi * n / sides), std::sin(2 * std::numbers::pi * n / sides)};
      };
      const auto along = [](const Point& p, const Point& q, double s) {
        return Point{p.x + s * (q.x - p.x), p.y + s * (q.y - p.y)};
      };
      const double at = 0.4 + 0.2 * unit(), width = 0.001 + 0.01 * unit(), height = 0.3 + 0.6 * unit();
      corners.push_back(corner(k));
      corners.push_back(along(corner(k), corner(k + 1), at - width));
      corners.push_back(along(along(corner(k), corner(k + 1), at), {0, 0}, height));
      corners.push_back(along(corner(k), corner(k + 1), at + width));
    }
    Outline outline = outline_of(corners, 0.04, 15 * kDegree);
    for (Outline::Station& station : outline.stations) station.usable = station.usable && !station.corner;
    const std::optional<Fork> fork = find_fork(outline, 15 * kDegree);
    if (!fork) continue;
    ++forks;
    for (const Outline::Station& end : fork->ends)
      for (std::size_t k = 0; k < outline.loop.size(); ++k) {
        const Point &u = outline.loop[k].at, &v = outline.loop[(k + 1) % outline.loop.size()].at;
        if (u == end.at || v == end.at || (!end.corner && outline.loop[k].side == end.side)) continue;
        CHECK(!testing::comes_near(fork->center, end.at, u, v));
      }
  }
  CHECK(forks > 30);
}

TEST_CASE("there is no fork where the border is not seen, or the angle leaves no room") {
  CHECK(!find_fork(outline_of({{0, 0}, {3, 0}, {3, 3}, {2.9, 0.1}, {0.1, 0.1}}, 0.1, kDegree), kDegree));  // L
  CHECK(!find_fork(outline_of({{0, 0}, {2, 0}, {1, std::sqrt(3.0)}}, 0.1, 100 * kDegree), 100 * kDegree));
}

TEST_CASE("a niche that cannot be seen from the center rules out a fork") {
  const std::vector<Point> square = {{0, 0}, {3, 0}, {3, 3}, {0, 3}};
  const std::vector<Point> with_niche = {{0, 0},     {3, 0},     {3, 1},   {3.3, 1}, {3.3, 1.5},
                                         {3.2, 1.5}, {3.2, 1.1}, {3, 1.1}, {3, 3},   {0, 3}};
  CHECK(find_fork(outline_of(square, 0.2, 30 * kDegree), 30 * kDegree));
  CHECK(!find_fork(outline_of(with_niche, 0.2, 30 * kDegree), 30 * kDegree));
}

TEST_CASE("there is no fork where only two walls offer ends") {
  // At 50 degrees no separator leaves the corners, and the shorter sides have no other ends unless these are dense.
  const std::vector<Point> corners = {{0, 0}, {2.1, 0}, {2.1, 1}, {0, 1}};
  CHECK(!find_fork(outline_of(corners, 0.7, 50 * kDegree), 50 * kDegree));
  CHECK(find_fork(outline_of(corners, 0.1, 50 * kDegree), 50 * kDegree));
}
