#include "decompose/separator_room.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "decompose/bridges.hpp"
#include "decompose/fork.hpp"
#include "driftmesh/repair.hpp"
#include "geometry/segment_geometry.hpp"
#include "support/prepared_mesh.hpp"

// What separators keep away from, and that bridges and forks keep away from it.

using namespace driftmesh;

namespace {

constexpr double kBridgeAngle = std::numbers::pi / 3;

/// Whether uw comes nearer to some point of ab than 0.01 of its length and 0.346 of the distance to its nearer end.
bool comes_near(const Point& a, const Point& b, const Point& u, const Point& w) {
  const double length = std::hypot(b.x - a.x, b.y - a.y);
  for (double t = 0.02; t < 0.99; t += 0.02) {
    const double keep = 0.999 * length * std::min({0.01, 0.346 * t, 0.346 * (1 - t)});
    if (squared_distance_to_segment({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)}, u, w) < keep * keep) return true;
  }
  return false;
}

std::string text(const Point& a, const Point& b) {
  return std::to_string(a.x) + " " + std::to_string(a.y) + " to " + std::to_string(b.x) + " " + std::to_string(b.y);
}

/// The first bridge of a map that comes near to a wall that it does not meet, in words.
std::string narrow_bridge(const PlanarMap& map) {
  const auto ends = [&](WallId w) {
    const SideId h = PlanarMap::first_side(w);
    return std::pair(map.at(map.start(h)), map.at(map.end(h)));
  };
  for (const WallId bridge : ids_of(map.walls)) {
    if (map.walls[bridge].kind != PlanarMap::Kind::kBridge) continue;
    const auto [a, b] = ends(bridge);
    for (const WallId wall : ids_of(map.walls)) {
      const auto [u, w] = ends(wall);
      if (u == a || u == b || w == a || w == b || !comes_near(a, b, u, w)) continue;
      return text(a, b) + " beside " + text(u, w);
    }
  }
  return "";
}

Outline outline_with(const std::vector<Point>& corners, double spacing) {
  Pslg pslg;
  pslg.points = corners;
  const auto count = static_cast<std::int32_t>(corners.size());
  for (std::int32_t i = 0; i < count; ++i) pslg.segments.push_back({i, (i + 1) % count, 1});
  const PlanarMap map = connected_walls(testing::prepared(pslg), 10, kBridgeAngle);
  SideId inside = kNone;
  for (const SideId h : ids_of(map.sides))
    if (map.side(h).in_domain()) inside = h;
  Outline outline;
  read_loop(map, inside, outline.loop);
  place_stations(map, spacing, kBridgeAngle, outline);
  return outline;
}

}  // namespace

TEST_CASE("the room is low, and narrow at the ends") {
  const SeparatorRoom room({0, 0}, {100, 0});
  for (const double sign : {1.0, -1.0}) {
    CHECK(room.contains({50, sign * 0.99}));
    CHECK(!room.contains({50, sign * 1.01}));
    CHECK(room.contains({1, sign * 0.36}));  // seen at 19.8 degrees
    CHECK(!room.contains({1, sign * 0.38}));
    CHECK(room.contains({99, sign * 0.36}));
    CHECK(!room.contains({99, sign * 0.38}));
  }
  CHECK(!room.contains({0, 0}));
  CHECK(!room.contains({-1, 0}));
  CHECK(!room.contains({101, 0}));
}

TEST_CASE("a wall can pass through the room with both ends outside") {
  const SeparatorRoom room({0, 0}, {100, 0});
  CHECK(room.is_entered_by({-1, 0.5}, {101, 0.5}));
  CHECK(room.is_entered_by({101, -0.5}, {0, -1e-6}));
  CHECK(room.is_entered_by({50, -2}, {50, 2}));
  CHECK(!room.is_entered_by({-1, 1.01}, {101, 1.01}));
  CHECK(!room.is_entered_by({0, 1e-6}, {10, 10}));
  CHECK(!room.is_entered_by({-5, 0}, {0, 0}));
  CHECK(!room.is_entered_by({100, 0}, {200, 0}));
}

TEST_CASE("more room can be wanted beside corners, but not less") {
  CHECK(SeparatorRoom({0, 0}, {100, 0}, 2).contains({50, 1.9}));
  CHECK(!SeparatorRoom({0, 0}, {100, 0}, 2).is_entered_by({-50, 1.9}, {150, 1.9}));
  CHECK(SeparatorRoom({0, 0}, {100, 0}, 0.1).contains({50, 0.9}));
}

TEST_CASE("bridges do not run beside a wall") {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int k = 0; k < 60; ++k) {
    CAPTURE(k);
    Pslg pslg;
    pslg.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (std::int32_t i = 0; i < 4; ++i) pslg.segments.push_back({i, (i + 1) % 4, 1});
    const double height = std::pow(10, -2 - 7 * unit(random));
    const int count = 2 + static_cast<int>(random() % 40);
    for (int i = 1; i < count; ++i)
      pslg.points.push_back({static_cast<double>(i) / count, height * (0.5 + unit(random))});
    CHECK(narrow_bridge(connected_walls(testing::prepared(pslg), 0.2 + unit(random), kBridgeAngle)) == "");
  }
}

TEST_CASE("forks do not run beside a wall") {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  int forks = 0;
  for (int k = 0; k < 2000; ++k) {
    CAPTURE(k);
    std::vector<Point> corners;
    const int count = 9 + static_cast<int>(random() % 12);
    for (int i = 0; i < count; ++i) {
      const double angle = 2 * std::numbers::pi * (i + 0.9 * unit(random)) / count;
      const double radius = random() % 2 == 0 ? 1 : 0.1 + 0.9 * unit(random);
      corners.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    const Outline outline = outline_with(corners, 0.1);
    const std::optional<Fork> fork = find_fork(outline, kBridgeAngle);
    if (!fork) continue;
    ++forks;
    for (const Outline::Station& end : fork->ends)
      for (std::size_t i = 0; i < outline.loop.size(); ++i) {
        const Point &u = outline.loop[i].at, &w = outline.loop[i + 1 < outline.loop.size() ? i + 1 : 0].at;
        const bool meets = u == end.at || w == end.at || (!end.corner && outline.loop[i].side == end.side);
        const bool is_near = !meets && comes_near(fork->center, end.at, u, w);
        CHECK(!is_near);
      }
  }
  CHECK(forks > 50);
}
