#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "property/cases.hpp"
#include "sizing/segment_distance.hpp"
#include "support/check_slopes.hpp"
#include "support/random.hpp"

// The distance to the nearest of some segments, against a look at each of them, wherever the segments and the points
// are, and what is known of it within smaller and smaller boxes.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

using Segments = std::vector<SegmentDistance::Ends>;

Point around(Random& random, const Point& p, double reach) {
  return {p.x + uniform(random, -reach, reach), p.y + uniform(random, -reach, reach)};
}

Point on(const SegmentDistance::Ends& s, double t) {
  return {s.a.x + t * (s.b.x - s.a.x), s.a.y + t * (s.b.y - s.a.y)};
}

Segments scattered(Random& random, int count) {
  Segments all;
  for (int i = 0; i < count; ++i) {
    const Point a = around(random, {}, 1);
    all.push_back({a, i % 9 == 0 ? a : around(random, a, i % 7 == 0 ? 1 : 0.05)});
    if (i % 11 == 0) all.push_back({all.back().b, all.back().a});
  }
  return all;
}

/// A coast of many short segments, some tiny, end to end, in a corner of a domain.
Segments chain(Random& random, int count) {
  Segments all{{{-1, -1}, {1, -1}}, {{1, -1}, {1, 1}}};
  Point last = around(random, {}, 1);
  for (int i = 0; i < count; ++i) {
    const Point next = around(random, last, i % 13 == 0 ? 1e-9 : 0.01);
    all.push_back({last, next});
    last = next;
  }
  return all;
}

Segments clustered(Random& random, int count) {
  Segments all;
  for (int i = 0; i < count; ++i) {
    const double width = std::pow(10, -2 * (i % 5));
    const Point a = around(random, {0.3, -0.2}, width);
    all.push_back({a, around(random, a, width / 4)});
  }
  return all;
}

/// Points in the middle are as near to all as to any.
Segments circle(Random& random, int count) {
  const auto at = [&](int i) { return Point{std::cos(6.28 * i / count), std::sin(6.28 * i / count)}; };
  Segments all;
  for (int i = 0; i < count; ++i) all.push_back({at(i), at(i + 1)});
  std::ranges::shuffle(all, random);
  return all;
}

Segments star(Random& random, int count) {
  const Point middle = around(random, {}, 0.1);
  Segments all;
  for (int i = 0; i < count; ++i) all.push_back({middle, around(random, {}, 1)});
  return all;
}

/// On one line, with gaps, overlapping and touching.
Segments collinear(Random& random, int count) {
  const Point from = around(random, {}, 1), to = around(random, {}, 1);
  Segments all;
  for (int i = 0; i < count; ++i) {
    const double t = uniform(random, 0, 1);
    all.push_back({on({from, to}, t), on({from, to}, t + uniform(random, 0, 0.02))});
  }
  return all;
}

/// Segments of a grid with few lines: many distances are equal.
Segments on_grid(Random& random, int count) {
  const auto whole = [&] { return std::floor(uniform(random, 0, 9)); };
  Segments all;
  for (int i = 0; i < count; ++i) {
    const Point a{whole(), whole()};
    all.push_back({a, i % 2 == 0 ? Point{whole(), a.y} : Point{a.x, whole()}});
  }
  return all;
}

Segments random_segments(Random& random) {
  const int count = random() % 6 == 0 ? 1 + static_cast<int>(random() % 9) : 10 + static_cast<int>(random() % 290);
  constexpr std::array kKinds{scattered, chain, clustered, circle, star, collinear, on_grid};
  Segments all = kKinds[random() % kKinds.size()](random, count);
  const double scale = std::pow(10, uniform(random, -6, 6));
  const Point shift = random() % 2 == 0 ? Point{} : around(random, {}, scale * std::pow(10, uniform(random, 0, 12)));
  for (SegmentDistance::Ends& s : all)
    for (Point* end : {&s.a, &s.b}) *end = {scale * end->x + shift.x, scale * end->y + shift.y};
  return all;
}

/// Somewhere, where two segments are equally far, on one, and out of all bounds.
Point random_place(Random& random, const Segments& segments, const Box& box) {
  const double side = std::max(box.high.x - box.low.x, box.high.y - box.low.y);
  const auto any = [&] { return on(segments[random() % segments.size()], uniform(random, 0, 1)); };
  switch (random() % 8) {
    case 0:
      return any();
    case 1: {
      const Point p = any(), q = any();
      return {(p.x + q.x) / 2, (p.y + q.y) / 2};
    }
    case 2:
      return segments[random() % segments.size()].a;
    case 3:
      return box.center();
    case 4:
      return around(random, box.center(), side * std::pow(10, uniform(random, 0, 3)));
    default:
      return around(random, box.center(), 0.55 * side);
  }
}

double to_segment(const Point& p, const SegmentDistance::Ends& s) {
  const double ex = s.b.x - s.a.x, ey = s.b.y - s.a.y, square = ex * ex + ey * ey;
  const double t = square > 0 ? std::clamp(((p.x - s.a.x) * ex + (p.y - s.a.y) * ey) / square, 0.0, 1.0) : 0;
  return std::hypot(p.x - s.a.x - t * ex, p.y - s.a.y - t * ey);
}

double one_by_one(const Segments& segments, const Point& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const SegmentDistance::Ends& s : segments) least = std::min(least, to_segment(p, s));
  return least;
}

Box box_of(const Segments& segments) {
  Box box;
  for (const SegmentDistance::Ends& s : segments) box.extend(Box::around(s.a, s.b));
  return box;
}

/// A quarter of a box.
Box quarter(const Box& box, std::uint64_t k) {
  const Point m = box.center();
  return {{k % 2 == 0 ? box.low.x : m.x, k < 2 ? box.low.y : m.y},
          {k % 2 == 0 ? m.x : box.high.x, k < 2 ? m.y : box.high.y}};
}

}  // namespace

TEST_CASE("the nearest of random segments is that of a look at each of them") {
  Random random = seeded_generator("nearest");
  for (std::int64_t c = 0; c < case_count(150); ++c) {
    CAPTURE(c);
    const Segments segments = random_segments(random);
    const SegmentDistance distance(segments);
    const Box box = box_of(segments);
    const double extent = std::hypot(box.low.x, box.low.y) + std::hypot(box.high.x, box.high.y);
    int wrong = 0;
    for (int k = 0; k < 400; ++k) {
      const Point p = random_place(random, segments, box);
      const double expected = one_by_one(segments, p);
      wrong += std::fabs(distance.at(p) - expected) <= 1e-14 * (extent + expected) ? 0 : 1;
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("within smaller and smaller boxes distances stay the same, and bounds hold values and slopes") {
  Random random = seeded_generator("nearest within boxes");
  int narrowed = 0, straight = 0;
  constexpr std::int64_t kCases = 60;
  for (std::int64_t c = 0; more_cases(c, kCases, narrowed > 500 && straight > 100); ++c) {
    CAPTURE(c);
    const Segments segments = random_segments(random);
    const SegmentDistance whole(segments);
    const Box around_all = box_of(segments);
    const double side = std::max({around_all.high.x - around_all.low.x, around_all.high.y - around_all.low.y, 1e-12});
    const double rounding = 1e-13 * (side + std::hypot(around_all.high.x, around_all.high.y));
    for (int k = 0; k < 12; ++k) {
      std::shared_ptr<const PlaneFunction> function = std::make_shared<SegmentDistance>(segments);
      const Point target = random_place(random, segments, around_all);
      Box box{{target.x - side * uniform(random, 0.2, 2), target.y - side * uniform(random, 0.2, 2)}, {}};
      box.high = {box.low.x + 3 * side, box.low.y + 3 * side};
      for (int depth = 0; depth < 14 && box.high.x - box.low.x > 1e4 * rounding; ++depth) {
        if (auto less = function->within(box); less != nullptr) function = std::move(less), ++narrowed;
        const Variation found = function->over(box);
        for (int n = 0; n < 6; ++n) {
          const Point p = somewhere_in(random, box), q = somewhere_in(random, box);
          const double at_p = function->at(p);
          CHECK(std::fabs(at_p - whole.at(p)) <= rounding);
          CHECK((at_p >= found.value.low - rounding && at_p <= found.value.high + rounding));
          check_slopes(*function, found, p, q, rounding);
        }
        straight += found.in_x.high - found.in_x.low < 0.01 && found.in_y.high - found.in_y.low < 0.01 ? 1 : 0;
        const Point m = box.center();
        box = quarter(box, (target.x < m.x ? 0U : 1U) + (target.y < m.y ? 0U : 2U));
      }
    }
  }
}
