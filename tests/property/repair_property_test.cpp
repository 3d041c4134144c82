#include <doctest/doctest.h>

#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "driftmesh/repair.hpp"
#include "support/random.hpp"

using namespace driftmesh;
using namespace driftmesh::testing;
using Rational = boost::multiprecision::cpp_rational;

namespace {

// The oracle: exact rational arithmetic on all pairs, nothing shared with the code under test.

struct ExactPoint {
  Rational x, y;
  bool operator==(const ExactPoint&) const = default;
};

ExactPoint exact(const Point& p) {
  return {Rational(p.x), Rational(p.y)};
}

int turn(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c) {
  const Rational area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  return area.sign();
}

bool within(const Rational& v, const Rational& a, const Rational& b) {
  return (a <= v && v <= b) || (b <= v && v <= a);
}

bool on_closed_segment(const ExactPoint& p, const ExactPoint& a, const ExactPoint& b) {
  return turn(a, b, p) == 0 && within(p.x, a.x, b.x) && within(p.y, a.y, b.y);
}

// Empty if `pslg` is a planar straight line graph, otherwise the problem.
std::string planarity_fault(const Pslg& pslg) {
  std::vector<ExactPoint> p;
  for (const Point& point : pslg.points) p.push_back(exact(point));
  for (std::size_t i = 0; i < p.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (p[i] == p[j]) return "points " + std::to_string(j) + " and " + std::to_string(i) + " are equal";
  const auto& segments = pslg.segments;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const auto a = static_cast<std::size_t>(segments[i].a), b = static_cast<std::size_t>(segments[i].b);
    if (a == b) return "segment " + std::to_string(i) + " has length zero";
    for (std::size_t v = 0; v < p.size(); ++v)
      if (v != a && v != b && on_closed_segment(p[v], p[a], p[b]))
        return "point " + std::to_string(v) + " lies on segment " + std::to_string(i);
    for (std::size_t j = 0; j < i; ++j) {
      const auto c = static_cast<std::size_t>(segments[j].a), d = static_cast<std::size_t>(segments[j].b);
      if ((a == c && b == d) || (a == d && b == c)) return "segments repeat: " + std::to_string(j);
      if (a == c || a == d || b == c || b == d) continue;  // more than the shared end would put an end on the other
      if (turn(p[a], p[b], p[c]) * turn(p[a], p[b], p[d]) < 0 && turn(p[c], p[d], p[a]) * turn(p[c], p[d], p[b]) < 0)
        return "segments " + std::to_string(j) + " and " + std::to_string(i) + " cross";
    }
  }
  return "";
}

double distance(const Point& p, const Point& a, const Point& b) {
  const double dx = b.x - a.x, dy = b.y - a.y, length2 = dx * dx + dy * dy;
  const double t = length2 == 0 ? 0 : std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / length2, 0.0, 1.0);
  return std::hypot(p.x - a.x - t * dx, p.y - a.y - t * dy);
}

// The largest distance from a sample on a segment of `from` to the nearest segment of `to`.
double one_sided_distance(const Pslg& from, const Pslg& to) {
  double largest = 0;
  for (const Pslg::Segment& s : from.segments) {
    const Point a = from.points[static_cast<std::size_t>(s.a)], b = from.points[static_cast<std::size_t>(s.b)];
    if (a == b) continue;
    for (const double t : {0.0, 0.13, 0.5, 0.71, 1.0}) {
      const Point sample{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
      double nearest = INFINITY;
      for (const Pslg::Segment& o : to.segments)
        nearest = std::min(nearest, distance(sample, to.points[static_cast<std::size_t>(o.a)],
                                             to.points[static_cast<std::size_t>(o.b)]));
      largest = std::max(largest, nearest);
    }
  }
  return largest;
}

double magnitude(const Pslg& pslg) {
  double largest = 0;
  for (const Point& p : pslg.points) largest = std::max({largest, std::fabs(p.x), std::fabs(p.y)});
  return largest;
}

bool same_lines(const Pslg& a, const Pslg& b) {
  return a.points == b.points && a.segments == b.segments && a.point_markers == b.point_markers &&
         a.attributes == b.attributes;
}

// Scales by a power of two, which changes no decision.
Pslg scaled(Pslg pslg, double factor) {
  for (Point& p : pslg.points) p = {p.x * factor, p.y * factor};
  return pslg;
}

// Sets of segments, each with one kind of difficulty.

void add_random_segments(Pslg& pslg, Random& random, int count) {
  const auto last = static_cast<std::int32_t>(pslg.points.size()) - 1;
  for (int i = 0; i < count; ++i)
    pslg.segments.push_back({integer(random, 0, last), integer(random, 0, last), integer(random, 0, 2)});
}

Pslg integer_grid(Random& random) {
  Pslg pslg;
  for (int i = 0; i < 15; ++i)
    pslg.points.push_back({static_cast<double>(integer(random, 0, 5)), static_cast<double>(integer(random, 0, 5))});
  add_random_segments(pslg, random, 12);
  return pslg;
}

Pslg random_reals(Random& random) {
  Pslg pslg;
  for (int i = 0; i < 16; ++i) pslg.points.push_back({uniform(random, -1, 1), uniform(random, -1, 1)});
  add_random_segments(pslg, random, 10);
  return pslg;
}

// Points computed to lie on earlier segments, as programs do that make T-junctions: most miss by rounding.
Pslg computed_junctions(Random& random) {
  Pslg pslg;
  const double shift = integer(random, 0, 1) * 4e6;
  for (int i = 0; i < 4; ++i) pslg.points.push_back({shift + uniform(random, 0, 1), shift + uniform(random, 0, 1)});
  pslg.segments = {{0, 1, 1}, {2, 3, 2}};
  for (int i = 0; i < 6; ++i) {
    const auto on = static_cast<std::size_t>(integer(random, 0, static_cast<std::int32_t>(pslg.segments.size()) - 1));
    const Point a = pslg.points[static_cast<std::size_t>(pslg.segments[on].a)];
    const Point b = pslg.points[static_cast<std::size_t>(pslg.segments[on].b)];
    const double t = uniform(random, 0, 1);
    pslg.points.push_back({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)});
    pslg.segments.push_back({static_cast<std::int32_t>(pslg.points.size()) - 1, integer(random, 0, 3), 3});
  }
  return pslg;
}

// Long lines that differ by a few units in the last place: they cross several times once ends are rounded.
Pslg nearly_parallel(Random& random) {
  Pslg pslg;
  for (int i = 0; i < 8; ++i) {
    const double tilt = integer(random, -20, 20) * 0x1p-52, lift = integer(random, -20, 20) * 0x1p-52;
    const double x0 = uniform(random, 0, 0.4), x1 = uniform(random, 0.6, 1);
    pslg.points.push_back({x0, 0.3 + x0 * 0.7 + lift});
    pslg.points.push_back({x1, 0.3 + x1 * 0.7 + lift + tilt});
    pslg.segments.push_back({2 * i, 2 * i + 1, i});
  }
  return pslg;
}

// Lines through one point, which no two crossings computed from them hit exactly.
Pslg pencil(Random& random) {
  Pslg pslg;
  const Point center{uniform(random, -1, 1), uniform(random, -1, 1)};
  for (int i = 0; i < 7; ++i) {
    const double angle = uniform(random, 0, 3.14159), r = uniform(random, 0.1, 10), s = uniform(random, 0.1, 10);
    pslg.points.push_back({center.x + r * std::cos(angle), center.y + r * std::sin(angle)});
    pslg.points.push_back({center.x - s * std::cos(angle), center.y - s * std::sin(angle)});
    pslg.segments.push_back({2 * i, 2 * i + 1, 0});
  }
  return pslg;
}

// The spacing of doubles itself as the grid: everything is close to everything.
Pslg last_place_grid(Random& random) {
  Pslg pslg;
  for (int i = 0; i < 20; ++i)
    pslg.points.push_back({1 + integer(random, 0, 40) * 0x1p-52, 1 + integer(random, 0, 40) * 0x1p-52});
  pslg.points.push_back({0, 1});
  pslg.points.push_back({0.5, 0});
  add_random_segments(pslg, random, 12);
  return pslg;
}

struct Kind {
  const char* name;
  Pslg (*make)(Random&);
};
const Kind kKinds[] = {{"integer grid", integer_grid},
                       {"random reals", random_reals},
                       {"computed junctions", computed_junctions},
                       {"nearly parallel", nearly_parallel},
                       {"pencil", pencil},
                       {"last place grid", last_place_grid}};

void decorate(Pslg& pslg, Random& random) {
  pslg.attributes_per_point = 1;
  for (const Point& p : pslg.points) {
    pslg.attributes.push_back(2 * p.x - p.y);
    pslg.point_markers.push_back(integer(random, 0, 3));
  }
}

}  // namespace

TEST_CASE("repair makes any set of segments planar, keeps its shape, and is idempotent") {
  std::int64_t crossings = 0, overlaps = 0, on_segments = 0, close_segments = 0, close_points = 0, duplicates = 0;
  for (const Kind& kind : kKinds) {
    for (std::uint64_t seed = 1; seed <= 120; ++seed) {
      CAPTURE(std::string(kind.name));
      CAPTURE(seed);
      Random random(seed);
      Pslg input = kind.make(random);
      decorate(input, random);
      Pslg once = input;
      const RepairReport report = repair(once);
      REQUIRE(planarity_fault(once) == "");
      // A vertex is moved by a few units in the last place at a time; a chain of them may add up.
      const double reach = 200 * 0x1p-52 * magnitude(input);
      CHECK(one_sided_distance(input, once) <= reach);
      CHECK(one_sided_distance(once, input) <= reach);
      CHECK(once.point_markers.size() == once.points.size());
      CHECK(once.attributes.size() == once.points.size());
      CHECK(report.original_point.size() == once.points.size());
      for (std::size_t i = 0; i < once.points.size(); ++i)
        CHECK(once.attributes[i] == doctest::Approx(2 * once.points[i].x - once.points[i].y).epsilon(1e-6));
      Pslg large = scaled(input, 0x1p200);
      repair(large);
      CHECK(large.segments == once.segments);
      CHECK(large.points == scaled(once, 0x1p200).points);
      Pslg twice = once;
      CHECK_FALSE(repair(twice).changed());
      CHECK(same_lines(once, twice));
      crossings += report.crossings.count;
      overlaps += report.overlaps.count;
      on_segments += report.points_on_segments.count;
      close_segments += report.points_close_segments.count;
      close_points += report.close_points.count;
      duplicates += report.duplicate_points.count;
    }
  }
  // The inputs really contained their difficulties.
  CHECK(crossings > 1000);
  CHECK(overlaps > 100);
  CHECK(on_segments > 100);
  CHECK(close_segments > 100);
  CHECK(close_points > 100);
  CHECK(duplicates > 100);
}

TEST_CASE("the oracle sees every kind of fault") {
  Pslg pslg;
  pslg.points = {{0, 0}, {2, 2}, {0, 2}, {2, 0}, {1, 1}};
  pslg.segments = {{0, 1, 0}};
  CHECK(planarity_fault(pslg) == "point 4 lies on segment 0");
  pslg.points[4] = {5, 5};
  CHECK(planarity_fault(pslg) == "");
  pslg.segments.push_back({2, 3, 0});
  CHECK(planarity_fault(pslg) == "segments 0 and 1 cross");
  pslg.segments[1] = {1, 0, 0};
  CHECK(planarity_fault(pslg) == "segments repeat: 0");
  pslg.segments[1] = {3, 3, 0};
  CHECK(planarity_fault(pslg) == "segment 1 has length zero");
  pslg.points[4] = {0, 2};
  CHECK(planarity_fault(pslg) == "points 2 and 4 are equal");
}

namespace {

/// Rings, lines and points with gaps, slivers and steps of about the length by which they are snapped.
Pslg rough_outlines(Random& random, double length) {
  Pslg pslg;
  const auto noise = [&] { return uniform(random, -1.2, 1.2) * length; };
  const int rings = integer(random, 1, 4);
  for (int r = 0; r < rings; ++r) {
    const auto first = static_cast<std::int32_t>(pslg.points.size());
    const double x = integer(random, 0, 3), y = integer(random, 0, 3), w = integer(random, 1, 3),
                 h = integer(random, 1, 3);
    for (const Point& corner : {Point{x, y}, Point{x + w, y}, Point{x + w, y + h}, Point{x, y + h}}) {
      const int repeats = integer(random, 1, 3);
      for (int i = 0; i < repeats; ++i) pslg.points.push_back({corner.x + noise(), corner.y + noise()});
    }
    const auto count = static_cast<std::int32_t>(pslg.points.size()) - first;
    const bool open = integer(random, 0, 2) == 0;
    for (std::int32_t i = 0; i + (open ? 1 : 0) < count; ++i)
      pslg.segments.push_back({first + i, first + (i + 1) % count, r});
  }
  const int lines = integer(random, 0, 4);
  for (int i = 0; i < lines; ++i) {
    const auto first = static_cast<std::int32_t>(pslg.points.size());
    pslg.points.push_back({uniform(random, 0, 5), uniform(random, 0, 5)});
    pslg.points.push_back({uniform(random, 0, 5), uniform(random, 0, 5)});
    pslg.segments.push_back({first, first + 1, 9});
  }
  for (int i = integer(random, 0, 4); i > 0; --i) pslg.points.push_back({uniform(random, 0, 5), uniform(random, 0, 5)});
  return pslg;
}

double total_length(const Pslg& pslg) {
  double sum = 0;
  for (const Pslg::Segment& s : pslg.segments) {
    const Point &a = pslg.points[static_cast<std::size_t>(s.a)], &b = pslg.points[static_cast<std::size_t>(s.b)];
    sum += std::hypot(b.x - a.x, b.y - a.y);
  }
  return sum;
}

}  // namespace

TEST_CASE("snapping leaves no two vertices within its length, and moves none by more") {
  std::int64_t merged = 0, bent = 0, collapsed = 0;
  for (std::uint64_t seed = 1; seed <= 1500; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    const double length = std::exp2(integer(random, -12, -2)) * uniform(random, 0.5, 1);
    CAPTURE(length);
    const Pslg input = rough_outlines(random, length);
    Pslg snapped = input;
    const RepairReport report = repair(snapped, "input", {.snap = length});
    REQUIRE(planarity_fault(snapped) == "");
    const double most = length * (1 + 1e-9);
    CHECK(report.largest_move <= most);
    for (std::size_t i = 0; i < snapped.points.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        CHECK(std::hypot(snapped.points[i].x - snapped.points[j].x, snapped.points[i].y - snapped.points[j].y) >
              length);
    for (const Pslg::Segment& s : snapped.segments) {
      const Point a = snapped.points[static_cast<std::size_t>(s.a)], b = snapped.points[static_cast<std::size_t>(s.b)];
      const double along = std::hypot(b.x - a.x, b.y - a.y);
      for (const Point& p : snapped.points) {
        const double t = ((p.x - a.x) * (b.x - a.x) + (p.y - a.y) * (b.y - a.y)) / along;
        if (t <= most || t >= along - most) continue;
        CHECK(distance(p, a, b) > length * (1 - 1e-9));
      }
    }
    // Each point that stays is one of the input, where it was, or a crossing.
    for (std::size_t i = 0; i < snapped.points.size(); ++i)
      if (const std::int32_t original = report.original_point[i]; original >= 0)
        CHECK(snapped.points[i] == input.points[static_cast<std::size_t>(original)]);
    // Segments are bent by the length, and pieces of them again.
    CHECK(one_sided_distance(snapped, input) <= 3 * length);
    CHECK(total_length(snapped) <= 1.5 * total_length(input));
    Pslg twice = snapped;
    CHECK_FALSE(repair(twice, "input", {.snap = length}).changed());
    CHECK(same_lines(snapped, twice));
    merged += report.close_points.count;
    bent += report.points_close_segments.count;
    collapsed += report.collapsed.count;
  }
  CHECK(merged > 1000);
  CHECK(bent > 100);
  CHECK(collapsed > 10);
}

TEST_CASE("rings that snapping closes vanish; lines, borders and the rest of a ring stay") {
  Pslg pslg;
  pslg.points = {{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  pslg.segments = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 0, 1}};
  const auto add = [&](const std::vector<Point>& chain, bool closed, std::int32_t marker) {
    const auto first = static_cast<std::int32_t>(pslg.points.size()), count = static_cast<std::int32_t>(chain.size());
    pslg.points.insert(pslg.points.end(), chain.begin(), chain.end());
    for (std::int32_t i = 0; i + (closed ? 0 : 1) < count; ++i)
      pslg.segments.push_back({first + i, first + (i + 1) % count, marker});
  };
  add({{1, 1}, {2, 1}, {2, 1.01}, {1, 1.01}}, true, 2);  // a thin island
  add({{3, 3}, {3.01, 3}, {3, 3.01}}, true, 3);          // a tiny one
  add({{1, 2}, {2, 2}}, false, 4);                       // two lines side by side
  add({{1, 2.01}, {2, 2.01}}, false, 5);
  add({{4.01, 0}, {6, 0}, {6, 4}, {4.01, 4}}, true, 6);                              // a neighbor with a gap
  add({{0.5, 2}, {0.51, 3}, {0.52, 2}, {0.8, 2}, {0.8, 1.5}, {0.5, 1.5}}, true, 7);  // an island with a spike
  const RepairReport report = repair(pslg, "input", {.snap = 0.05});
  std::multiset<std::int32_t> markers;
  for (const Pslg::Segment& s : pslg.segments) markers.insert(s.marker);
  CHECK(markers.count(1) == 4);
  CHECK(markers.count(2) == 0);
  CHECK(markers.count(3) == 0);
  CHECK(markers.count(4) == 1);
  CHECK(markers.count(5) == 0);
  CHECK(markers.count(6) == 3);
  CHECK(markers.count(7) == 4);
  CHECK(report.collapsed.count == 2);
  CHECK(pslg.points.size() == 4 + 2 + 2 + 4);
  CHECK(report.summary().find("within 0.05 of another merged (the largest move is ") != std::string::npos);
}

TEST_CASE("a hole whose ring is closed by snapping removes nothing") {
  for (const double height : {0.001, 0.5}) {
    Pslg pslg;
    pslg.points = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {1, 1}, {2, 1}, {2, 1 + height}, {1, 1 + height}};
    pslg.segments = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 0, 1}, {4, 5, 2}, {5, 6, 2}, {6, 7, 2}, {7, 4, 2}};
    pslg.holes = {{1.5, 1 + height / 2}};
    pslg.regions = {{{3, 3}, 5, 0}};
    const RepairReport report = repair(pslg, "input", {.snap = 0.01});
    CHECK(pslg.holes.size() == (height == 0.5 ? 1 : 0));
    CHECK(pslg.regions.size() == 1);
    REQUIRE(report.warnings.size() == (height == 0.5 ? 0 : 1));
    if (height != 0.5) CHECK(report.warnings[0].find("hole 1 at (1.5, 1.0005) is left out") == 0);
  }
}

TEST_CASE("the hull is added to segments where there are none, and counts as no change") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    Pslg input = kKinds[seed % 2].make(random);
    Pslg plain = input;
    const RepairReport without = repair(plain);
    Pslg hulled = input;
    const RepairReport with = repair(hulled, "input", {.hull = true});
    REQUIRE(planarity_fault(hulled) == "");
    CHECK(with.overlaps.count == without.overlaps.count);
    CHECK(with.duplicate_segments.count == without.duplicate_segments.count);
    // The input's segments first, as they are without the hull, and then what closes the hull.
    REQUIRE(hulled.segments.size() >= plain.segments.size());
    for (std::size_t i = 0; i < plain.segments.size(); ++i) CHECK(hulled.segments[i] == plain.segments[i]);
    for (const Point& p : hulled.points) {
      bool outside = false;
      for (std::size_t i = plain.segments.size(); i < hulled.segments.size(); ++i) {
        const Pslg::Segment& s = hulled.segments[i];
        CHECK(s.marker == 1);
        outside = outside || turn(exact(hulled.points[static_cast<std::size_t>(s.a)]),
                                  exact(hulled.points[static_cast<std::size_t>(s.b)]), exact(p)) < 0;
      }
      CHECK_FALSE(outside);
    }
  }
}
