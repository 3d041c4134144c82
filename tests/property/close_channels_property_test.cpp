#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <tuple>
#include <vector>

#include "driftmesh/close_channels.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/generate.hpp"
#include "driftmesh/repair.hpp"
#include "geometry/midpoint.hpp"
#include "mesh/cdt.hpp"
#include "mesh/domain_outline.hpp"
#include "property/cases.hpp"
#include "support/outline_distance.hpp"
#include "support/random_channels.hpp"

// What is left of random domains without their narrow channels, judged by the geometry of both outlines alone.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

using Segment = SegmentDistance::Ends;

double area_of(const OutlineSegments& outline) {
  double twice = 0;
  for (const auto& [a, b] : outline) twice += a.x * b.y - a.y * b.x;
  return twice / 2;
}
bool is_inside(const OutlineSegments& outline, const Point& p) {
  bool inside = false;
  for (const auto& [a, b] : outline)
    if ((a.y <= p.y) != (b.y <= p.y) && a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) > p.x) inside = !inside;
  return inside;
}

/// The way along the rings of an outline, which lies to the right of the domain.
class Ways {
 public:
  explicit Ways(const OutlineSegments& outline) : outline_(outline), ring_(outline.size(), -1), along_(outline.size()) {
    for (std::size_t first = 0; first < outline.size(); ++first) {
      double along = 0;
      for (std::size_t i = first; ring_[i] < 0; i = next(i)) {
        ring_[i] = static_cast<std::int32_t>(lengths_.size());
        along_[i] = along;
        along += gap(outline[i].a, outline[i].b);
      }
      if (along > 0) lengths_.push_back(along);
    }
  }
  /// The shorter way between points on two segments; infinite if they are on different rings.
  [[nodiscard]] double between(std::size_t i, const Point& p, std::size_t j, const Point& q) const {
    if (ring_[i] != ring_[j]) return HUGE_VAL;
    const double way = std::fabs(along_[i] + gap(outline_[i].a, p) - along_[j] - gap(outline_[j].a, q));
    return std::min(way, lengths_[static_cast<std::size_t>(ring_[i])] - way);
  }
  /// Where rings touch, the first in clockwise direction.
  [[nodiscard]] std::size_t next(std::size_t i) const {
    const Segment& s = outline_[i];
    const double back = std::atan2(s.a.y - s.b.y, s.a.x - s.b.x);
    std::size_t best = i;
    double least = HUGE_VAL;
    for (std::size_t j = 0; j < outline_.size(); ++j) {
      if (!(outline_[j].a == s.b)) continue;
      double turn = back - std::atan2(outline_[j].b.y - s.b.y, outline_[j].b.x - s.b.x);
      if (turn <= 0) turn += 2 * std::numbers::pi;
      if (turn < least) least = turn, best = j;
    }
    return best;
  }

 private:
  const OutlineSegments& outline_;
  std::vector<std::int32_t> ring_;
  std::vector<double> along_;
  std::vector<double> lengths_;
};

/// Two places of an outline that a disk in the domain touches.
struct Crossing {
  Point from, to;
  double width;  // between them
  double way;    // along the outline
};

/// Disks that grow from all over the outline, by bisection and a look at each segment; at corners that the domain
/// surrounds in all directions.
class Disks {
 public:
  Disks(const OutlineSegments& outline, double most) : outline_(outline), ways_(outline), most_(most) {
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Segment& s = outline[i];
      const double length = gap(s.a, s.b);
      const Point normal{(s.a.y - s.b.y) / length, (s.b.x - s.a.x) / length};
      const int samples = std::clamp(static_cast<int>(8 * length / most), 3, 2000);
      for (int k = 0; k < samples; ++k) {
        const double t = (k + 0.5) / samples;
        grow(i, {s.a.x + t * (s.b.x - s.a.x), s.a.y + t * (s.b.y - s.a.y)}, normal);
      }
      const Segment& next = outline[ways_.next(i)];
      const double from = std::atan2(normal.y, normal.x);
      const double turn =
          std::remainder(std::atan2(next.b.x - next.a.x, next.a.y - next.b.y) - from, 2 * std::numbers::pi);
      for (int k = 1; turn < 0 && k < 12; ++k)
        grow(i, s.b, {std::cos(from + turn * k / 12), std::sin(from + turn * k / 12)});
    }
  }
  [[nodiscard]] const std::vector<Crossing>& crossings() const { return found_; }

 private:
  void grow(std::size_t own, const Point& foot, const Point& normal) {
    const auto center = [&](double r) { return Point{foot.x + r * normal.x, foot.y + r * normal.y}; };
    double low = 0, high = 2 * most_;
    if (to_outline(outline_, center(high)) >= high * (1 - 1e-9)) return;
    for (int step = 0; step < 40; ++step) {
      const double middle = (low + high) / 2;
      (to_outline(outline_, center(middle)) >= middle * (1 - 1e-9) ? low : high) = middle;
    }
    const Point c = center(low);
    for (std::size_t i = 0; i < outline_.size(); ++i) {
      const Point q = nearest_on(outline_[i], c);
      if (gap(q, c) > low * (1 + 1e-6) || gap(q, foot) > most_ || gap(q, foot) < 1e-3 * low) continue;
      found_.push_back({foot, q, gap(foot, q), ways_.between(own, foot, i, q)});
    }
  }

  const OutlineSegments& outline_;
  Ways ways_;
  double most_;
  std::vector<Crossing> found_;
};

std::vector<Crossing> crossings_of(const OutlineSegments& outline, double most) {
  return Disks(outline, most).crossings();
}

using Bits = std::tuple<double, double, double, double>;
std::set<Bits> bits_of(const OutlineSegments& outline) {
  std::set<Bits> bits;
  for (const auto& [a, b] : outline) bits.emplace(a.x, a.y, b.x, b.y);
  return bits;
}

bool same(const Pslg& p, const Pslg& q) {
  return p.points == q.points && p.segments == q.segments && p.polygons == q.polygons && p.holes == q.holes &&
         p.regions == q.regions && p.attributes == q.attributes && p.point_markers == q.point_markers;
}

Pslg bay(Random& random) {
  return generate("bay", {{"resolution", "1500"}, {"seed", std::to_string(random() % 1000)}});
}

}  // namespace

TEST_CASE("no channel is left that is narrower than asked for, and all else stays") {
  Random random = seeded_generator("closing channels");
  std::int64_t closed_some = 0;
  for (std::int64_t c = 0; c < case_count(60); ++c) {
    CAPTURE(c);
    const bool is_bay = c % 6 == 5;
    Pslg before = is_bay ? bay(random) : random_channel(random);
    const double width = is_bay ? uniform(random, 500, 5000) : uniform(random, 0.3, 1.6);
    CAPTURE(width);
    Pslg after;
    ClosedChannels report;
    try {
      repair(before);
      after = before;
      report = close_channels(after, width);
    } catch (const Error&) {  // banks that cross may enclose nothing, and all of it may be narrow
      continue;
    }
    if (report.channels == 0) {
      CHECK(same(after, before));
      CHECK(report.area == 0);
    }
    closed_some += report.channels > 0 ? 1 : 0;
    const OutlineSegments was = domain_outline(before), is = domain_outline(after);
    CHECK(area_of(was) - area_of(is) == doctest::Approx(report.area).epsilon(1e-6).scale(area_of(was)));

    // Nothing narrow is left.
    for (const Crossing& crossing : crossings_of(is, width))
      if (crossing.way > 2.2 * crossing.width) {
        CAPTURE(crossing.from.x);
        CAPTURE(crossing.from.y);
        CAPTURE(crossing.to.x);
        CAPTURE(crossing.to.y);
        CAPTURE(crossing.way);
        CHECK(crossing.width >= 0.97 * width);
      }

    // What is gone is near narrow places; the rest of the outline is the same to the last bit.
    std::vector<Point> narrow;
    for (const Crossing& crossing : crossings_of(was, 1.01 * width))
      if (crossing.way > 1.8 * crossing.width) narrow.push_back(midpoint(crossing.from, crossing.to));
    if (report.channels > 0) CHECK(!narrow.empty());
    const auto to_narrow = [&](const Point& p) {
      double least = HUGE_VAL;
      for (const Point& q : narrow) least = std::min(least, gap(p, q));
      return least;
    };
    const std::set<Bits> old_bits = bits_of(was), new_bits = bits_of(is);
    for (const Segment& s : is)
      if (!old_bits.contains({s.a.x, s.a.y, s.b.x, s.b.y})) CHECK(std::min(to_narrow(s.a), to_narrow(s.b)) < 2 * width);
    for (int k = 0; k < 100; ++k) {
      const Point p = somewhere_in(random, Box::of(before.points));
      if (is_inside(was, p) && !is_inside(is, p)) CHECK(to_narrow(p) < 3 * width);
      CHECK(!(is_inside(is, p) && !is_inside(was, p)));
    }

    // Once more changes nothing, and neither does repair.
    Pslg again = after;
    CHECK(close_channels(again, width).channels == 0);
    CHECK(same(again, after));
    CHECK(!repair(again).changed());
    CHECK(same(again, after));
  }
  CHECK(closed_some > case_count(60) / 4);
}

TEST_CASE("points, markers, constraints and regions go on") {
  // Two basins and a channel between them, with a constraint through all and a region in each.
  Pslg pslg;
  add_ring(pslg,
           {{0, 0},
            {10, 0},
            {10, 4.5},
            {20, 4.5},
            {20, 0},
            {30, 0},
            {30, 10},
            {20, 10},
            {20, 5.5},
            {10, 5.5},
            {10, 10},
            {0, 10}},
           5);
  pslg.points.insert(pslg.points.end(), {{5, 5}, {25, 5}, {2, 2}, {15, 4.6}});
  pslg.segments.push_back({12, 13, 9});
  pslg.attributes_per_point = 1;
  for (std::size_t i = 0; i < pslg.points.size(); ++i) pslg.attributes.push_back(pslg.points[i].x);
  pslg.regions.push_back({{1, 1}, 7, 0.5});
  pslg.names.markers[5] = "bank";
  repair(pslg);
  Pslg rest = pslg;
  const ClosedChannels closed = close_channels(rest, 2);
  CHECK(closed.channels == 1);
  CHECK(closed.parts == 2);
  CHECK(closed.area == doctest::Approx(10));
  CHECK(rest.polygons.size() == 2);
  CHECK(rest.names == pslg.names);
  std::multiset<std::int32_t> markers;
  for (const auto& s : rest.segments) markers.insert(s.marker);
  CHECK(markers.count(9) == 2);  // the constraint, on both sides
  CHECK(markers.count(5) == markers.size() - 2);
  CHECK(rest.regions.size() == 2);
  for (const auto& region : rest.regions) {
    CHECK(region.attribute == 7);
    CHECK(region.max_area == 0.5);
  }
  for (std::size_t i = 0; i < rest.points.size(); ++i) {
    CHECK(rest.attributes[i] == doctest::Approx(rest.points[i].x));
    const std::int32_t point = closed.original_point[i];
    if (point >= 0) CHECK(rest.points[i] == pslg.points[static_cast<std::size_t>(point)]);
  }
  CHECK(std::ranges::count(rest.points, Point{2, 2}) == 1);     // isolated, in a basin
  CHECK(std::ranges::count(rest.points, Point{15, 4.6}) == 0);  // in the channel
}

TEST_CASE("islands beside narrow straits become land") {
  Pslg pslg;
  add_ring(pslg, {{0, 0}, {20, 0}, {20, 20}, {0, 20}}, 1);
  add_ring(pslg, {{0.5, 5}, {5, 5}, {5, 10}, {0.5, 10}}, 2);  // half a unit from the shore
  add_ring(pslg, {{12, 10}, {15, 13}, {12, 16}, {9, 13}}, 2);
  add_ring(pslg, {{12, 9.8}, {9, 7}, {12, 4}, {15, 7}}, 2);  // a gap between two capes
  pslg.holes = {{2, 7}, {12, 13}, {12, 7}};
  repair(pslg);
  const ClosedChannels closed = close_channels(pslg, 1);
  CHECK(closed.channels >= 2);  // what is left of a gap may have to be filled again
  CHECK(closed.parts == 1);
  CHECK(closed.area > 3.3);  // the straits, and beside their ends as far as banks are less than 1 apart
  CHECK(closed.area < 3.6);
  REQUIRE(pslg.polygons.size() == 1);
  CHECK(pslg.polygons[0].rings.size() == 2);  // the shore with one island, and the other two in one ring
  CHECK(pslg.holes.empty());
}

TEST_CASE("corners stay unless they are sharper than 60 degrees") {
  for (const double degrees : {45.0, 58.0, 62.0, 75.0, 100.0}) {
    CAPTURE(degrees);
    const double half = degrees * std::numbers::pi / 360;
    Pslg kite;  // with that angle at its tip, and a wide one opposite
    add_ring(kite,
             {{0, 0}, {30 * std::sin(half), 30 * std::cos(half)}, {0, 45}, {-30 * std::sin(half), 30 * std::cos(half)}},
             1);
    repair(kite);
    const ClosedChannels closed = close_channels(kite, 3);
    CHECK(closed.channels == (degrees < 60 ? 1 : 0));
    double least = HUGE_VAL;
    for (const Point& p : kite.points) least = std::min(least, p.y);
    if (degrees < 60)
      CHECK(least == doctest::Approx(3 / (2 * std::tan(half))).epsilon(0.15));  // where the tip is 3 wide
    else
      CHECK(least == 0);
  }
}

TEST_CASE("what cannot be closed is refused") {
  Pslg strip;
  add_ring(strip, {{0, 0}, {10, 0}, {10, 1}, {0, 1}}, 1);
  repair(strip);
  CHECK_THROWS_AS(close_channels(strip, 0), Error);
  CHECK_THROWS_AS(close_channels(strip, -1), Error);
  CHECK_THROWS_AS(close_channels(strip, HUGE_VAL), Error);
  CHECK_THROWS_AS(close_channels(strip, 2), InputError);
  CHECK(close_channels(strip, 0.5).channels == 0);
}
