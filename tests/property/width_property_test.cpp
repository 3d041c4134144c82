#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "driftmesh/error.hpp"
#include "property/cases.hpp"
#include "sizing/expression.hpp"
#include "sizing/local_width.hpp"
#include "support/check_slopes.hpp"
#include "support/error_text.hpp"
#include "support/infinity.hpp"
#include "support/outline_distance.hpp"
#include "support/random.hpp"

// Widths of random outlines against their definition: balls that grow from all over the outline until they touch it
// again, by bisection and a look at each segment. And what is known of widths over boxes against values at points.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

using Segment = SegmentDistance::Ends;

OutlineSegments ring_of(const std::vector<Point>& points) {
  OutlineSegments ring;
  for (std::size_t i = 0; i < points.size(); ++i) ring.push_back({points[i], points[(i + 1) % points.size()]});
  return ring;
}

/// Bays, capes and acute corners.
OutlineSegments star(Random& random, int count, double least) {
  std::vector<Point> points;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count, radius = uniform(random, least, 1);
    points.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return ring_of(points);
}

/// A channel of varying width with bends, and sometimes an island in it.
OutlineSegments channel(Random& random, int count) {
  std::vector<Point> points, back;
  double y = 0;
  for (int i = 0; i <= count; ++i) {
    const double x = 2.0 * i / count - 1, half = uniform(random, 0.03, 0.12);
    y += uniform(random, -0.1, 0.1);
    points.push_back({x, y - half});
    back.push_back({x, y + half});
  }
  points.insert(points.end(), back.rbegin(), back.rend());
  OutlineSegments all = ring_of(points);
  if (random() % 2 == 0) return all;
  const Point a = points[1], b = back[2], c{(a.x + b.x) / 2, (a.y + b.y) / 2};
  const double r = 0.01;
  const OutlineSegments island = ring_of({{c.x - r, c.y}, {c.x, c.y + r}, {c.x + r, c.y}, {c.x, c.y - r}});
  all.insert(all.end(), island.begin(), island.end());
  return all;
}

OutlineSegments random_outline(Random& random) {
  const int count = static_cast<int>(4 + random() % 30);
  return random() % 2 == 0 ? star(random, count, 0.3) : channel(random, 2 + count / 3);
}

bool is_inside(const OutlineSegments& outline, const Point& p) {
  bool inside = false;
  for (const auto& [a, b] : outline)
    if ((a.y <= p.y) != (b.y <= p.y) && a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) > p.x) inside = !inside;
  return inside;
}
bool meet(const Segment& s, const Segment& t) {
  return s.a == t.a || s.a == t.b || s.b == t.a || s.b == t.b;
}

/// Centers of the largest balls in the domain, with the cosine of the angle between the points that they touch.
struct Ball {
  Point center;
  double cosine;
};

class Oracle {
 public:
  explicit Oracle(const OutlineSegments& outline) : outline_(outline) {
    constexpr int kSamples = 120;
    for (const Segment& s : outline) {
      const double length = gap(s.a, s.b);
      const Point normal{(s.a.y - s.b.y) / length, (s.b.x - s.a.x) / length};
      for (int k = 0; k <= kSamples; ++k) {
        const double t = static_cast<double>(k) / kSamples;
        grow({s.a.x + t * (s.b.x - s.a.x), s.a.y + t * (s.b.y - s.a.y)}, normal);
      }
      for (const Segment& next : outline) {
        if (!(next.a == s.b)) continue;
        const double from = std::atan2(normal.y, normal.x);
        const double turn =
            std::remainder(std::atan2(next.b.x - next.a.x, next.a.y - next.b.y) - from, 2 * std::numbers::pi);
        for (int k = 1; turn < 0 && k < kSamples; ++k) {
          const double angle = from + turn * k / kSamples;
          grow(s.b, {std::cos(angle), std::sin(angle)});
        }
      }
    }
  }

  /// Where only balls with no greater cosine count.
  [[nodiscard]] double width(const Point& p, double cosine) const {
    double least = kInfinity;
    for (const Ball& ball : balls_)
      if (ball.cosine <= cosine) least = std::min(least, gap(p, ball.center));
    return 2 * (to_outline(outline_, p) + least);
  }

 private:
  void grow(const Point& foot, const Point& normal) {
    double low = 0, high = 4;
    const auto center = [&](double r) { return Point{foot.x + r * normal.x, foot.y + r * normal.y}; };
    for (int step = 0; step < 50; ++step) {
      const double middle = (low + high) / 2;
      (to_outline(outline_, center(middle)) >= middle * (1 - 1e-9) ? low : high) = middle;
    }
    if (low < 1e-7) return;
    const Point c = center(low);
    double best = 2;
    for (const Segment& s : outline_) {
      const Point other = nearest_on(s, c);
      if (gap(other, c) > low * (1 + 1e-5)) continue;
      if (std::ranges::any_of(
              outline_, [&](const Segment& own) { return gap(nearest_on(own, foot), foot) < 1e-12 && !meet(own, s); }))
        best = std::min(best, ((foot.x - c.x) * (other.x - c.x) + (foot.y - c.y) * (other.y - c.y)) / (low * low));
    }
    if (best <= 1) balls_.push_back({c, best});
  }

  const OutlineSegments& outline_;
  std::vector<Ball> balls_;
};

Box box_around(const OutlineSegments& outline) {
  Box box;
  for (const Segment& s : outline) box.extend(Box::around(s.a, s.b));
  return box;
}

}  // namespace

TEST_CASE("widths are those of the balls that fit into an outline") {
  Random random = seeded_generator("widths");
  int compared = 0, all = 0, beyond = 0;
  for (std::int64_t c = 0; c < case_count(40); ++c) {
    CAPTURE(c);
    const OutlineSegments outline = random_outline(random);
    const Oracle oracle(outline);
    const LocalWidth width(outline);
    for (int k = 0; k < 60; ++k) {
      const Point p = somewhere_in(random, box_around(outline));
      if (!is_inside(outline, p)) continue;
      CAPTURE(p.x);
      CAPTURE(p.y);
      const double found = width.at(p), most = oracle.width(p, -0.56), least = oracle.width(p, -0.44);
      if (!std::isfinite(most)) continue;
      ++all;
      beyond += found >= 0.9 * least && found <= 1.1 * most ? 0 : 1;
      CHECK(found >= 0.75 * least);
      CHECK(found <= 1.25 * most);
      compared += most < 1.1 * least ? 1 : 0;
    }
  }
  CHECK(compared > 20 * case_count(40));
  CHECK(beyond <= all / 1000);  // where it depends on little whether a piece of the axis counts
}

TEST_CASE("a channel along the middle of the box has its width, although its axis is between squares") {
  Random random = seeded_generator("channels along the middle");
  for (std::int64_t c = 0; c < case_count(300); ++c) {
    CAPTURE(c);
    const int count = static_cast<int>(5 + random() % 60);
    const double step = uniform(random, 0.3, 3), half = uniform(random, 0.3, 0.7), end = count * step;
    std::vector<Point> points, back;
    for (int i = 0; i <= count; ++i) {
      points.push_back({i * step, -half});
      back.push_back({i * step, half});
    }
    points.insert(points.end(), back.rbegin(), back.rend());
    const LocalWidth width(ring_of(points));
    for (double x = half; x < end - half; x += half / 2)
      CHECK(width.at({x, uniform(random, -half, half)}) == doctest::Approx(2 * half).epsilon(0.1));
  }
}

TEST_CASE("in a straight channel the width is the distance of its sides, wherever and however it lies") {
  Random random = seeded_generator("straight channels");
  for (std::int64_t c = 0; c < case_count(200); ++c) {
    const double length = 10, wide = uniform(random, 0.01, 3), angle = uniform(random, 0, 7);
    const double scale = std::pow(10, uniform(random, -5, 5));
    const Point at{scale * uniform(random, -1e3, 1e3), scale * uniform(random, -1e3, 1e3)};
    const auto place = [&](double u, double v) {
      return Point{at.x + scale * (u * std::cos(angle) - v * std::sin(angle)),
                   at.y + scale * (u * std::sin(angle) + v * std::cos(angle))};
    };
    std::vector<Point> points{place(0, 0)};
    for (int k = 1; k < 5; ++k) points.push_back(place(2 * k, 0));
    for (const auto& [u, v] : {Point{length, 0}, {length, wide}, {0, wide}}) points.push_back(place(u, v));
    const LocalWidth width(ring_of(points));
    for (int k = 0; k < 20; ++k) {
      const double u = uniform(random, wide / 2, length - wide / 2), v = uniform(random, 0, wide);
      CHECK(width.at(place(u, v)) == doctest::Approx(scale * wide).epsilon(3e-3));
    }
    for (const Point& corner : points) CHECK(width.at(corner) >= 0.99 * scale * wide);
  }
}

TEST_CASE("width and curvature in formulas") {
  const FindOutline outline = [] { return ring_of({{0, 0}, {8, 0}, {8, 1}, {0, 1}}); };
  int asked = 0;
  const FindOutline counted = [&] { return ++asked, outline(); };
  const Expression rule("width()/4 + min(width(), 9)", nullptr, {}, counted);
  CHECK(rule.at({4, 0.3}) == doctest::Approx(1.25).epsilon(1e-3));
  CHECK(asked == 1);
  CHECK(Expression("1/curvature()", nullptr, {}, outline).at({8, 0}) == doctest::Approx(std::hypot(8, 1) / 2));
  for (const std::string name : {"width", "curvature"}) {
    const auto error = [&](const std::string& text, const FindOutline& of) {
      return error_text<InputError>([&] { (void)Expression(text, nullptr, {}, of); });
    };
    CHECK(mentions(error(name + "(1)", outline), "expected \")\": " + name + " takes no arguments"));
    CHECK(mentions(error("2*" + name + "()", {}), "column 3: there is no domain that " + name + " could measure"));
  }
}

TEST_CASE("corners ask for no width of their own") {
  for (const double height : {0.05, 0.3, 1.0, 3.0}) {  // triangles, with corners of 3 to 160 degrees
    const LocalWidth width(ring_of({{0, 0}, {1, 0}, {0.4, height}}));
    const double inscribed =
        height / (1 + std::hypot(0.4, height) + std::hypot(0.6, height));  // radius: twice the area over the perimeter
    CAPTURE(height);
    CHECK(width.at({0, 0}) > 2 * inscribed);
    CHECK(width.at({1, 0}) > 2 * inscribed);
    CHECK(width.at({0.4, height}) > 1.99 * inscribed);
  }
}

TEST_CASE("widths depend neither on the order of segments nor on questions before") {
  Random random = seeded_generator("order of segments");
  for (std::int64_t c = 0; c < case_count(20); ++c) {
    OutlineSegments outline = random_outline(random);
    const LocalWidth width(outline);
    std::ranges::shuffle(outline, random);
    const LocalWidth other(outline);
    for (int k = 0; k < 200; ++k) {
      const Point p = somewhere_in(random, box_around(outline));
      REQUIRE(width.at(p) == other.at(p));
    }
  }
}

TEST_CASE("within smaller and smaller boxes widths stay the same, and bounds hold values and slopes") {
  Random random = seeded_generator("widths within boxes");
  int narrowed = 0, close = 0, boxes = 0;
  for (std::int64_t c = 0; c < case_count(40); ++c) {
    CAPTURE(c);
    const OutlineSegments outline = random_outline(random);
    const auto whole = std::make_shared<const LocalWidth>(outline);
    for (int k = 0; k < 12; ++k) {
      std::shared_ptr<const PlaneFunction> function = whole;
      const Point target = somewhere_in(random, box_around(outline));
      Box box = Box::around(target, target, uniform(random, 0.5, 2));
      for (int depth = 0; depth < 16; ++depth, ++boxes) {
        if (auto less = function->within(box); less != nullptr) function = std::move(less), ++narrowed;
        const Variation found = function->over(box);
        for (int n = 0; n < 8; ++n) {
          const Point p = somewhere_in(random, box), q = somewhere_in(random, box);
          const double at_p = function->at(p);
          REQUIRE(std::fabs(at_p - whole->at(p)) <= 1e-13);
          REQUIRE(found.value.holds(at_p));
          check_slopes(*function, found, p, q, 1e-12);
        }
        close += found.value.high < 1.2 * found.value.low ? 1 : 0;
        const double half = (box.high.x - box.low.x) / 4;
        const Point m = somewhere_in(random, {{target.x - half / 2, target.y - half / 2}, {target.x, target.y}});
        box = Box::around(m, m, half);
      }
    }
  }
  CHECK(narrowed > boxes / 4);
  CHECK(close > boxes / 4);
}
