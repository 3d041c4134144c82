#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <thread>
#include <vector>

#include "property/cases.hpp"
#include "sizing/nearest_cells.hpp"

// The distance to the nearest of some segments, against a look at each of them: the same bits, wherever the segments
// and the points are, and in whatever order and by how many threads it is asked.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

using Random = std::mt19937_64;
using Segments = std::vector<NearestCells::Ends>;

double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

Point around(Random& random, const Point& p, double reach) {
  return {p.x + uniform(random, -reach, reach), p.y + uniform(random, -reach, reach)};
}

Point on(const NearestCells::Ends& s, double t) {
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
  for (NearestCells::Ends& s : all)
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

/// So many points around a place, closer and closer, that squares there are made and divided.
std::vector<Point> random_points(Random& random, const Segments& segments, const Box& box) {
  const double side = std::max(box.high.x - box.low.x, box.high.y - box.low.y);
  std::vector<Point> points;
  for (int k = 0; k < 6; ++k) {
    const Point place = random_place(random, segments, box);
    double reach = 0.1 * side;
    for (int i = 0; i < 150; ++i, reach *= 0.93) points.push_back(around(random, place, reach));
    points.push_back(place);
  }
  for (int k = 0; k < 300; ++k) points.push_back(random_place(random, segments, box));
  return points;
}

double one_by_one(const Segments& segments, const Point& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const NearestCells::Ends& s : segments) least = std::min(least, NearestCells::squared_distance(p, s));
  return least;
}

}  // namespace

TEST_CASE("the nearest of random segments is that of a look at each of them, to the last bit") {
  Random random = seeded_generator("nearest");
  int divided = 0;
  constexpr std::int64_t kCases = 150;
  for (std::int64_t c = 0; more_cases(c, kCases, divided > 20); ++c) {
    CAPTURE(c);
    const Segments segments = random_segments(random);
    const NearestCells cells(segments);
    int wrong = 0;
    for (const Point& p : random_points(random, segments, cells.box()))
      wrong += cells.squared_distance(p) != one_by_one(segments, p) ? 1 : 0;
    CHECK(wrong == 0);
    divided += cells.size() > 50 ? 1 : 0;
  }
}

TEST_CASE("there are no more squares than a number for each segment, and none without questions") {
  Random random = seeded_generator("number of squares");
  const Segments segments = circle(random, 500);
  const NearestCells cells(segments);
  CHECK(cells.size() == 1);
  const std::size_t most = 6 * segments.size() + 10'000;
  int wrong = 0;
  for (int i = 0; i < 100'000; ++i) {
    const Point p = around(random, {}, i % 2 == 0 ? 0.3 : 1e-2);
    wrong += cells.squared_distance(p) != one_by_one(segments, p) ? 1 : 0;
  }
  CHECK(wrong == 0);
  CHECK(cells.size() <= most);
  CHECK(cells.size() > most - 4);
}

TEST_CASE("threads that ask at once find what one does") {
  Random random = seeded_generator("nearest by threads");
  for (std::int64_t c = 0; c < case_count(20); ++c) {
    CAPTURE(c);
    const Segments segments = random_segments(random);
    const NearestCells cells(segments);
    const std::vector<Point> points = random_points(random, segments, cells.box());
    std::vector<double> expected(points.size());
    std::ranges::transform(points, expected.begin(), [&](const Point& p) { return one_by_one(segments, p); });
    std::vector<int> wrong(3, 0);
    std::vector<std::thread> threads;
    for (int& own : wrong)
      threads.emplace_back([&] {
        for (std::size_t i = 0; i < points.size(); ++i) own += cells.squared_distance(points[i]) != expected[i] ? 1 : 0;
      });
    for (std::thread& t : threads) t.join();
    CHECK(wrong == std::vector<int>(3, 0));
  }
}

TEST_CASE("coordinates whose squares are no numbers leave the answer to the tree") {
  Random random = seeded_generator("extreme coordinates");
  for (const double scale : {1e-310, 1e-200, 1e-162, 1e-158, 1e-154, 1e150, 1e154, 1e200}) {
    CAPTURE(scale);
    Segments segments = scattered(random, 60);
    for (NearestCells::Ends& s : segments)
      for (Point* end : {&s.a, &s.b}) *end = {scale * end->x, scale * end->y};
    const NearestCells cells(segments);
    int wrong = 0;
    for (const Point& p : random_points(random, segments, cells.box()))
      wrong += cells.squared_distance(p) != one_by_one(segments, p) ? 1 : 0;
    CHECK(wrong == 0);
    CHECK(cells.size() == 1);
  }
  constexpr double kFar = std::numeric_limits<double>::infinity();
  const Segments one{{{2, 3}, {2, 3}}};
  const NearestCells cells(one);
  for (const Point& p : {Point{kFar, 0}, Point{2, -kFar}, Point{1e300, 1}, Point{5, 7}, Point{2, 3}})
    CHECK(cells.squared_distance(p) == one_by_one(one, p));
}
