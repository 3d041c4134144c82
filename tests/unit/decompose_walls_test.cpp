#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "decompose/bridges.hpp"
#include "decompose/outline.hpp"
#include "decompose/pieces.hpp"
#include "support/prepared_mesh.hpp"

// Where bridges end on walls, and the directions in which separators may leave them.

using namespace driftmesh;
using driftmesh::testing::prepared;

namespace {

constexpr double kOneDegree = std::numbers::pi / 180;

/// A square that a wall divides, with a point on each side of it.
PlanarMap divided_square(const Point& above, const Point& below) {
  Pslg pslg;
  pslg.points = {{0, -16}, {16, -16}, {16, 0}, {16, 16}, {0, 16}, {0, 0}, above, below};
  pslg.segments = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 4, 1}, {4, 5, 1}, {5, 0, 1}, {5, 2, 2}};
  return connected_walls(prepared(pslg), 100, 60 * kOneDegree);
}

bool has_point(const PlanarMap& map, const Point& p) {
  return std::ranges::find(map.points, p) != map.points.end();
}

/// The angle from one direction counterclockwise to another, below 360 degrees.
double turn(const Point& from, const Point& to) {
  const double angle = std::atan2(from.x * to.y - from.y * to.x, from.x * to.x + from.y * to.y) / kOneDegree;
  return angle < 0 ? angle + 360 : angle;
}

}  // namespace

TEST_CASE("of the points beside a wall the nearest has its bridge at a right angle") {
  const Point foot{8.125, 0}, foot_of_farther{8, 0};
  for (const double side : {1.0, -1.0}) {
    CAPTURE(side);
    const Point nearer{foot.x, side}, farther{foot_of_farther.x, -5 * side};
    const PlanarMap map = side > 0 ? divided_square(nearer, farther) : divided_square(farther, nearer);
    CHECK(has_point(map, foot));
    CHECK(!has_point(map, foot_of_farther));  // the foot of the nearer one is about as good
  }
}

TEST_CASE("separators leave corners, also reflex ones, at no less than the angle from either wall") {
  const std::vector<Point> corners = {{0, 0}, {4, 0}, {4, 2}, {2, 2}, {2, 4}, {0, 4}};
  Pslg pslg;
  pslg.points = corners;
  pslg.segments = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 4, 1}, {4, 5, 1}, {5, 0, 1}};
  for (const double angle : {20.0, 40.0, 60.0}) {
    CAPTURE(angle);
    const PlanarMap map = connected_walls(prepared(pslg), 10, angle * kOneDegree);
    Outline outline;
    read_loop(map, find_pieces(map, QualityBounds{})[PieceId{0}].side, outline.loop);
    place_stations(map, 10, angle * kOneDegree, outline);
    REQUIRE(outline.stations.size() == corners.size());
    for (const Outline::Station& station : outline.stations) {
      const auto k = static_cast<std::size_t>(std::ranges::find(corners, station.at) - corners.begin());
      REQUIRE(k < corners.size());
      const Point &at = corners[k], &after = corners[(k + 1) % 6], &before = corners[(k + 5) % 6];
      const Point forward{after.x - at.x, after.y - at.y}, backward{before.x - at.x, before.y - at.y};
      const double inside = turn(forward, backward);
      CHECK(station.usable == (inside > 2 * angle));
      CHECK(station.reflex == (inside - 2 * angle >= 180));
      for (double degrees = 0.5; degrees < 360 && station.usable; ++degrees) {
        CAPTURE(degrees);
        const Point leaving{std::cos(degrees * kOneDegree), std::sin(degrees * kOneDegree)};
        const double turned = turn(forward, leaving);
        CHECK(Outline::allows(station, leaving.x, leaving.y) == (turned >= angle && turned <= inside - angle));
      }
    }
  }
}
