#include "decompose/separator_room.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "decompose/bridges.hpp"
#include "decompose/pieces.hpp"
#include "decompose/star.hpp"
#include "driftmesh/repair.hpp"
#include "geometry/segment_geometry.hpp"
#include "support/prepared_mesh.hpp"

// What separators keep away from, and that bridges and smoothing keep away from it.

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

TEST_CASE("smoothing does not move a separator beside a wall") {
  // Separators from the middle of a square down, up and to the right; left of the lower one a wall that stands on the
  // border ends just below the middle, so that no corner is in the room.
  for (const Point& tip : {Point{0.995, 0.9995}, Point{0.995, 0.5}}) {
    Pslg pslg;
    pslg.points = {{0, 0}, {0.995, 0}, {2, 0}, {2, 2}, {0, 2}, tip};
    pslg.segments = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 4, 1}, {4, 0, 1}, {1, 5, 2}};
    PlanarMap map = connected_walls(testing::prepared(pslg), 10, kBridgeAngle);
    const auto split = [&](const Point& a, const Point& b, const Point& m) -> SideId {
      for (const SideId h : ids_of(map.sides))
        if (map.side(h).in_domain() && map.at(map.start(h)) == a && map.at(map.end(h)) == b)
          return map.split(h, map.add_point(m, kNone));
      FAIL("there is no such side");
      return kNone;
    };
    const SideId bottom = split({0.995, 0}, {2, 0}, {1, 0}), top = split({2, 2}, {0, 2}, {1, 2});
    (void)map.connect(bottom, top, PlanarMap::Kind::kSeparator);
    const SideId right = split({2, 0}, {2, 2}, {2, 1}), middle = split({1, 2}, {1, 0}, {1, 1});
    (void)map.connect(middle, right, PlanarMap::Kind::kSeparator);
    const IdVector<PieceId, Piece> pieces = find_pieces(map, QualityBounds{});
    const IdVector<SideId, PieceId> piece_of = label_sides(map, pieces);
    Star star(map, piece_of, kBridgeAngle);
    REQUIRE(star.read(middle));
    CHECK(star.allows({0.3, 0}, {0, 0}));
    CHECK(!star.allows({0, 0}, {0, 0}));
    CHECK(!star.allows({0.002, 0}, {0, 0}));
  }
}
