#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "driftmesh/error.hpp"
#include "sizing/expression_field.hpp"
#include "sizing/make_size_field.hpp"
#include "sizing/segment_distance.hpp"
#include "support/error_text.hpp"
#include "support/random.hpp"

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

/// Short and long segments with markers 1 to 5, some of them points, some equal.
Pslg random_segments(Random& random, int count, double scale) {
  Pslg pslg;
  for (int i = 0; i < count; ++i) {
    const Point a{scale * uniform(random, -1, 1), scale * uniform(random, -1, 1)};
    const double length = scale * (i % 7 == 0 ? 1 : i % 5 == 0 ? 0 : 0.02);
    pslg.points.push_back(a);
    pslg.points.push_back({a.x + length * uniform(random, -1, 1), a.y + length * uniform(random, -1, 1)});
    pslg.segments.push_back({2 * i, 2 * i + 1, 1 + i % 5});
    if (i % 11 == 0) pslg.segments.push_back(pslg.segments.back());
  }
  return pslg;
}

double between(const Point& p, const Point& q) {
  return std::hypot(p.x - q.x, p.y - q.y);
}

/// By cases: to an end unless the foot of the perpendicular lies between the ends.
double to_segment(const Point& p, const Point& a, const Point& b) {
  const double ab = between(a, b);
  const auto along = [&](const Point& from, const Point& to) {
    return (p.x - from.x) * (to.x - from.x) + (p.y - from.y) * (to.y - from.y);
  };
  if (ab == 0 || along(a, b) <= 0) return between(p, a);
  if (along(b, a) <= 0) return between(p, b);
  return std::fabs((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x)) / ab;
}

double one_by_one(const Pslg& pslg, const std::set<std::int32_t>& markers, const Point& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const Pslg::Segment& s : pslg.segments)
    if (markers.empty() || markers.contains(s.marker))
      least = std::min(least, to_segment(p, pslg.points[s.a], pslg.points[s.b]));
  return least;
}

/// The marked_square of side 4 at the origin, with markers 1 to 4 counterclockwise from the bottom.
Pslg marked_square() {
  Pslg pslg;
  pslg.points = {{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  pslg.segments = {{0, 1, 1}, {1, 2, 2}, {2, 3, 3}, {3, 0, 4}};
  return pslg;
}

std::string error_of(const std::string& expression, const Pslg* input) {
  return error_text<InputError>(
      [&] { ExpressionField(expression, 0, std::numeric_limits<double>::infinity(), input); });
}

}  // namespace

TEST_CASE("distances are those to the nearest of all segments, looked at one by one") {
  const std::vector<std::vector<std::int32_t>> choices{{}, {1}, {2, 5}, {1, 2, 3, 4, 5}};
  for (const std::uint64_t seed : {1, 2, 3}) {
    CAPTURE(seed);
    Random random(seed);
    for (const int count : {5, 9, 64, 700}) {
      const double scale = std::pow(10, uniform(random, -6, 6));
      const Pslg pslg = random_segments(random, count, scale);
      for (const auto& markers : choices) {
        const SegmentDistance distance(pslg, markers);
        const std::set<std::int32_t> chosen(markers.begin(), markers.end());
        for (int i = 0; i < 200; ++i) {
          const double reach = i % 3 == 0 ? 20 : 1.2;
          const Point p = i % 10 == 0 ? pslg.points[i % pslg.points.size()]
                                      : Point{scale * uniform(random, -reach, reach), scale * uniform(random, -1, 1)};
          CHECK(std::fabs(distance.at(p) - one_by_one(pslg, chosen, p)) <= 1e-13 * scale * reach);
        }
      }
    }
  }
}

TEST_CASE("the bounds over a box hold every distance in it, and are no wider than its diagonal") {
  for (const std::uint64_t seed : {4, 5, 6}) {
    CAPTURE(seed);
    Random random(seed);
    const double scale = std::pow(10, uniform(random, -6, 6));
    const Pslg pslg = random_segments(random, 100, scale);
    const SegmentDistance distance(pslg, std::array<std::int32_t, 1>{3});
    int tight = 0;
    for (int i = 0; i < 500; ++i) {
      const Point low{scale * uniform(random, -2, 2), scale * uniform(random, -2, 2)};
      const double width = scale * std::pow(10, uniform(random, -14, 0)) * (i % 4);
      const Box box{low, {low.x + width * uniform(random, 0, 1), low.y + width}};
      const Interval bounds = distance.over(box).value;
      CHECK(bounds.low >= 0);
      const double diagonal = between(box.low, box.high);
      CHECK(bounds.high - bounds.low <= diagonal + 1e-12 * scale);
      double least = bounds.high, most = bounds.low;
      for (int k = 0; k < 40; ++k) {
        const double s = k < 4 ? k % 2 : uniform(random, 0, 1), t = k < 4 ? k / 2 : uniform(random, 0, 1);
        const Point p{std::min(box.low.x + s * (box.high.x - box.low.x), box.high.x),
                      std::min(box.low.y + t * (box.high.y - box.low.y), box.high.y)};
        const double value = distance.at(p);
        CHECK(bounds.holds(value));
        least = std::min(least, value);
        most = std::max(most, value);
      }
      if (most - least > 0.5 * (bounds.high - bounds.low)) ++tight;
    }
    CHECK(tight > 100);
  }
}

TEST_CASE("bounds of distances over boxes without an end") {
  const Pslg pslg = marked_square();
  const SegmentDistance distance(pslg, {});
  constexpr double kFar = std::numeric_limits<double>::infinity();
  for (const Box& box : {Box{{-kFar, -kFar}, {kFar, kFar}}, Box{{0, 0}, {kFar, 1}}}) {
    CHECK(distance.over(box).value.low == 0);
    CHECK(distance.over(box).value.high == kFar);
  }
}

TEST_CASE("an expression uses distances to segments with markers") {
  const Pslg pslg = marked_square();
  constexpr double kFar = std::numeric_limits<double>::infinity();
  const auto value = [&](const std::string& expression, const Point& p) {
    return ExpressionField(expression, 0, kFar, &pslg).edge_length(p);
  };
  CHECK(value("0.5 + 0.1*distance(1)", {1, 2.5}) == doctest::Approx(0.75));
  CHECK(value("distance()", {1, 2.5}) == doctest::Approx(1));
  CHECK(value("distance ( 1 ,3 ) + 10 * distance(2)", {1, 3.5}) == doctest::Approx(30.5));
  CHECK(value("min(distance(1), distance(2), distance(1)) + x*distance(4)^2", {1, 3.5}) == doctest::Approx(4));
  CHECK(value("1 + distance(4, 4)", {-3, 8}) == doctest::Approx(6));
}

TEST_CASE("lengths that fall to a segment between the corners of a triangle are found") {
  Pslg pslg = marked_square();
  pslg.points.insert(pslg.points.end(), {{1, 2}, {1.001, 2}});
  pslg.segments.push_back({4, 5, 7});
  const auto field = make_size_field(
      {.expression = "0.01 + distance(7)", .spacing = 0.002, .domain = {{0, 0}, {4, 4}}, .input = &pslg});
  const std::array<Point, 3> around{Point{0.6, 1.8}, {1.5, 1.7}, {1.1, 2.6}}, beside{Point{2, 1}, {3, 1}, {2.5, 2}};
  CHECK(field->falls_below(around, 0.02));
  CHECK_FALSE(field->falls_below(around, 0.01));
  CHECK_FALSE(field->falls_below(beside, 0.9));
  CHECK(field->least() == doctest::Approx(0.01));
}

TEST_CASE("a size field measures distances in the input of its options") {
  const Pslg pslg = marked_square();
  SizingOptions options{.expression = "0.1 + distance(1)", .gradation = 0.25, .longest = 0.8, .spacing = 0.002};
  options.domain = {{0, 0}, {4, 4}};
  options.input = &pslg;
  const auto field = make_size_field(options);
  CHECK(field->edge_length({2, 0}) == doctest::Approx(0.1).epsilon(0.12));
  CHECK(field->edge_length({2, 2}) == doctest::Approx(0.6).epsilon(0.1));
  CHECK(field->edge_length({2, 4}) == doctest::Approx(0.8));
}

TEST_CASE("errors in distances name the column, and the markers that exist") {
  const Pslg pslg = marked_square();
  CHECK(mentions(error_of("1 + distance(1.5)", &pslg), "column 14: the arguments of distance are markers"));
  CHECK(mentions(error_of("1 + distance(x)", &pslg), "column 14: the arguments"));
  CHECK(mentions(error_of("1 + distance(1", &pslg), "column 15: the arguments"));
  CHECK(mentions(error_of("1 + distance(1,)", &pslg), "column 16: the arguments"));
  CHECK(mentions(error_of("1 + distance(99999999999)", &pslg), "column 14: the arguments"));
  CHECK(mentions(error_of("1 + distance(2147483648)", &pslg), "column 14: the arguments"));
  CHECK(mentions(error_of("distance", &pslg), "column 9: the expression ends, expected \"(\" after \"distance\""));
  CHECK(mentions(error_of("mydistance(1)", &pslg), "\"mydistance\" is not known"));
  CHECK(mentions(error_of("distance(1) + z", &pslg), "column 15: \"z\" is not known"));
  CHECK(mentions(error_of("1 + distance(1, 7)", &pslg),
                 "column 5: no segment has the marker 7; the markers of segments are 1, 2, 3, 4"));
  CHECK(mentions(error_of("distance(-1)", &pslg), "the marker -1;"));
  CHECK(mentions(error_of("distance()", nullptr), "there are no segments that distance could measure to"));
  const Pslg empty;
  CHECK(mentions(error_of("distance(1)", &empty), "there are no segments"));
}

TEST_CASE("errors in slopes name the column, and names that have a meaning are not for rasters") {
  CHECK(mentions(error_of("1+slope(2*depth)", nullptr), "column 9: the argument of slope is the name of a raster"));
  CHECK(mentions(error_of("slope()", nullptr), {"column 7", "slope(depth)"}));
  CHECK(mentions(error_of("slope(depth", nullptr), "column 12"));
  CHECK(mentions(error_of("2*slope(dept)", nullptr), {"column 9: slope asks for the raster 'dept'", "input.rasters"}));
  for (const char* name : {"depth", "_", "Depth2", "x1", "slope_a", "distance_0"}) CHECK(can_name_raster(name));
  for (const char* name : {"", "x", "pi", "_e", "2a", "a-b", "sqrt", "hypot", "asinh", "distance", "slope"})
    CHECK_FALSE(can_name_raster(name));
}
