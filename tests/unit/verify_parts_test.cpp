#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "verify/arrangement.hpp"
#include "verify/chains.hpp"
#include "verify/domain.hpp"
#include "verify/quality.hpp"
#include "verify/report_text.hpp"
#include "verify/verify.hpp"

using namespace driftmesh;

namespace {

std::vector<Point> square(double x, double y, double side) {
  return {{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}};
}

void add_loop(std::vector<Point>& points, std::vector<Arrangement::Link>& links, const std::vector<Point>& loop) {
  const auto first = static_cast<std::int32_t>(points.size()), n = static_cast<std::int32_t>(loop.size());
  points.insert(points.end(), loop.begin(), loop.end());
  for (std::int32_t i = 0; i < n; ++i) links.push_back({first + i, first + (i + 1) % n});
}

Mesh one_triangle(Point a, Point b, Point c) {
  Mesh mesh;
  mesh.points = {a, b, c};
  mesh.triangles = {{0, 1, 2}};
  mesh.edges = {{0, 1, 1}, {1, 2, 1}, {2, 0, 1}};
  return mesh;
}

}  // namespace

TEST_CASE("an arrangement of nested squares: each ring is a face of two boundary parts") {
  std::vector<Point> points;
  std::vector<Arrangement::Link> links;
  add_loop(points, links, square(0, 0, 10));
  add_loop(points, links, square(1, 1, 8));
  add_loop(points, links, square(2, 2, 2));
  add_loop(points, links, square(5, 5, 2));
  points.push_back({4.5, 4.5});
  const Arrangement a(points, links,
                      {{0.5, 0.5}, {1.5, 1.5}, {3, 3}, {6, 6}, {20, 3}, {0, 4}, {10, 10}, {3, 8.5}, {4.5, 4.5}});
  REQUIRE(!a.conflict());
  CHECK(a.face_count() == 5);
  CHECK(a.face_of_query(4) == Arrangement::kUnbounded);
  CHECK(a.face_of_query(5) == Arrangement::kOnBoundary);
  CHECK(a.face_of_query(6) == Arrangement::kOnBoundary);
  CHECK(a.face_of_query(1) == a.face_of_query(7));
  CHECK(a.face_of_point(16) == a.face_of_query(1));
  CHECK(a.face_of_query(8) == a.face_of_query(1));  // on a point without links
  CHECK(a.face_of_point(0) == Arrangement::kOnBoundary);
  CHECK(a.left_face(0) == a.face_of_query(0));
  CHECK(a.right_face(0) == Arrangement::kUnbounded);
  CHECK(a.left_face(4) == a.face_of_query(1));
  CHECK(a.right_face(4) == a.face_of_query(0));
  CHECK(a.left_face(8) == a.face_of_query(2));
  CHECK(a.left_face(12) == a.face_of_query(3));
  CHECK(a.boundary_parts(Arrangement::kUnbounded) == 1);
  CHECK(a.boundary_parts(a.face_of_query(0)) == 2);
  CHECK(a.boundary_parts(a.face_of_query(1)) == 4);
  CHECK(a.boundary_parts(a.face_of_query(2)) == 1);
}

TEST_CASE("points that coincide or are no places, and links without length, are conflicts wherever they are listed") {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::vector<Point> points = square(0, 0, 4);
  const std::vector<Arrangement::Link> links{{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  for (std::size_t i = 0; i < 4; ++i)
    for (const Point& other : {points[(i + 1) % 4], points[(i + 2) % 4], Point{kNone, 1}, Point{1, kNone},
                               Point{std::numeric_limits<double>::infinity(), 1}, Point{1e300, 0}, Point{1e-300, 0}}) {
      std::vector<Point> moved = points;
      moved[i] = other;
      CAPTURE(i);
      CAPTURE(other.x);
      CHECK(Arrangement(moved, links).conflict());
    }
  points.push_back({2, 0});
  CHECK(Arrangement(points, links).conflict());  // on a link
  points.back() = {2, 2};
  CHECK(!Arrangement(points, links).conflict());
  CHECK(Arrangement(points, {{0, 1}, {1, 2}, {2, 2}}).conflict());
  CHECK(Arrangement(points, {{0, 1}, {1, 2}, {1, 0}}).conflict());
  points.push_back({2, 2});
  CHECK(Arrangement(points, links).conflict());
  points.back() = {-0.0, 0.0};
  CHECK(Arrangement(points, links).conflict());
}

TEST_CASE("queries that are no places are outside of everything") {
  const std::vector<Arrangement::Link> links{{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  const Arrangement a(square(0, 0, 4), links, {{nan, 2}, {2, 2}, {2, nan}, {inf, 2}, {2, -inf}, {1e300, 2}, {3, 3}});
  REQUIRE(!a.conflict());
  for (const std::size_t query : {0, 2, 3, 4, 5}) CHECK(a.face_of_query(query) == Arrangement::kUnbounded);
  CHECK(a.face_of_query(1) != Arrangement::kUnbounded);
  CHECK(a.face_of_query(6) == a.face_of_query(1));
}

TEST_CASE("an arrangement with verticals, a dangling link and squares that share a corner") {
  std::vector<Point> points;
  std::vector<Arrangement::Link> links;
  add_loop(points, links, square(0, 0, 4));
  points.insert(points.end(), {{8, 4}, {8, 8}, {4, 8}, {2, 4.5}, {1, 1}, {1, 3}});
  links.insert(links.end(), {{2, 4}, {4, 5}, {5, 6}, {6, 2}});  // a square at the corner (4, 4)
  links.push_back({8, 9});                                      // a separate link inside the first
  const Arrangement a(points, links, {{2, 2}, {6, 6}, {2, 6}, {1, 2}});
  REQUIRE(!a.conflict());
  CHECK(a.face_count() == 3);
  CHECK(a.face_of_query(0) != a.face_of_query(1));
  CHECK(a.face_of_query(2) == Arrangement::kUnbounded);
  CHECK(a.face_of_query(3) == Arrangement::kOnBoundary);
  CHECK(a.left_face(8) == a.face_of_query(0));
  CHECK(a.right_face(8) == a.face_of_query(0));
  CHECK(a.face_of_point(7) == Arrangement::kUnbounded);
  CHECK(a.boundary_parts(Arrangement::kUnbounded) == 2);
}

TEST_CASE("links that cross, overlap or touch are a conflict, whatever their order") {
  const auto conflict = [](std::vector<Point> points) {
    const bool one = Arrangement(points, {{0, 1}, {2, 3}}).conflict().has_value();
    const bool other = Arrangement(points, {{3, 2}, {1, 0}}).conflict().has_value();
    CHECK(one == other);
    return one;
  };
  CHECK(conflict({{0, 0}, {2, 2}, {0, 2}, {2, 0}}));   // cross
  CHECK(conflict({{0, 0}, {2, 0}, {1, 0}, {1, 5}}));   // an end inside the other link
  CHECK(conflict({{0, 0}, {0, 4}, {0, 1}, {0, 9}}));   // overlap on a vertical
  CHECK(conflict({{0, 0}, {4, 4}, {1, 1}, {2, 2}}));   // one in the other
  CHECK(conflict({{0, 0}, {0, 4}, {-1, 2}, {1, 2}}));  // cross a vertical
  CHECK(conflict({{0, 0}, {1, 1}, {0.5, 0.5}, {3, 0}}));
  CHECK(!conflict({{0, 0}, {1, 1}, {2, 2}, {3, 3}}));
  CHECK(!conflict({{0, 0}, {2, 2}, {0, 1}, {2, 3}}));
  CHECK(!conflict({{0, 0}, {0, 1}, {0, 2}, {0, 3}}));
  CHECK(Arrangement({{0, 0}, {4, 4}, {2, 2}}, {{0, 1}}).conflict());  // a lone point on a link
  CHECK(Arrangement({{0, 0}, {4, 4}}, {{0, 1}, {1, 0}}).conflict());  // a link twice
  CHECK(!Arrangement({{0, 0}, {4, 4}, {8, 8}}, {{0, 1}, {1, 2}}).conflict());
}

TEST_CASE("the domain without segments is the convex hull") {
  Pslg input;
  input.points = {{0, 0}, {2, 0}, {4, 0}, {4, 3}, {0, 3}, {1, 1}, {2, 0}};
  const Domain domain(input);
  REQUIRE(!domain.conflict());
  CHECK(domain.area() == 12);
  CHECK(domain.segments().size() == 5);
  CHECK(domain.euler_number() == 1);
  input.points = {{0, 0}, {1, 1}, {3, 3}};
  CHECK(Domain(input).area() == 0);
}

TEST_CASE("Euler numbers of domains") {
  Pslg input;
  const auto add = [&](const std::vector<Point>& loop) {
    const auto first = static_cast<std::int32_t>(input.points.size()), n = static_cast<std::int32_t>(loop.size());
    input.points.insert(input.points.end(), loop.begin(), loop.end());
    for (std::int32_t i = 0; i < n; ++i) input.segments.push_back({first + i, first + (i + 1) % n, 0});
  };
  add(square(0, 0, 10));
  CHECK(Domain(input).euler_number() == 1);
  add(square(1, 1, 2));
  CHECK(Domain(input).euler_number() == 1);  // a loop of segments inside
  input.holes.push_back({2, 2});
  CHECK(Domain(input).euler_number() == 0);
  CHECK(Domain(input).area() == 96);
  add(square(20, 0, 1));
  CHECK(Domain(input).euler_number() == 1);  // two components
  input.points.push_back({5, 5});
  CHECK(Domain(input).euler_number() == 1);  // a point changes nothing
}

TEST_CASE("segments outside the domain do not count") {
  Pslg input;
  input.points = {{0, 0}, {1, 0}, {0, 1}, {5, 5}, {6, 5}};
  input.segments = {{0, 1, 0}, {1, 2, 0}, {2, 0, 0}, {3, 4, 0}};
  Mesh mesh = one_triangle({0, 0}, {1, 0}, {0, 1});
  for (auto& edge : mesh.edges) edge.marker = 0;
  CHECK(verify(mesh, input, {}).accepted());
}

TEST_CASE("angles and areas of known triangles") {
  const double half = std::sqrt(3.0) / 2;
  for (const double scale : {1.0, 1e-20, 1e20}) {
    const VerifyReport report = verify(one_triangle({0, 0}, {scale, 0}, {scale / 2, half * scale}), {});
    CHECK(report.quality.smallest_angle == doctest::Approx(60));
    CHECK(report.quality.largest_angle == doctest::Approx(60));
    CHECK(report.area == doctest::Approx(half / 2 * scale * scale));
  }
  for (const double degrees : {1e-5, 0.5, 1.5, 7.5, 29.5, 33.5, 44.5}) {
    const double t = std::tan(degrees / 180 * std::numbers::pi);
    const VerifyReport report = verify(one_triangle({0, 0}, {1, 0}, {1, t}), {});
    CHECK(report.quality.smallest_angle == doctest::Approx(degrees).epsilon(1e-9));
    CHECK(report.quality.largest_angle == doctest::Approx(90).epsilon(1e-9));
    CHECK(report.quality.angles[static_cast<std::size_t>(degrees)] >= 1);
    CHECK(report.quality.angles[static_cast<std::size_t>(90 - degrees)] >= 1);
    CHECK(report.quality.angles[90] == 1);
  }
}

TEST_CASE("the bins of the histogram hold every angle") {
  for (int d = 1; d < 179; ++d) {
    const double angle = (d + 0.5) / 180 * std::numbers::pi;
    const VerifyReport report = verify(one_triangle({0, 0}, {1, 0}, {std::cos(angle), std::sin(angle)}), {});
    CAPTURE(d);
    CHECK(report.quality.angles[d] >= 1);
    std::uint64_t sum = 0, tens = 0;
    for (const auto n : report.quality.angles) sum += n;
    for (const auto n : report.quality.angles_by_ten()) tens += n;
    CHECK(sum == 3);
    CHECK(tens == 3);
    CHECK(report.quality.angles_by_ten()[d / 10] >= 1);
  }
}

TEST_CASE("the area bound of a size field is that of its shortest length at the corners and the centroid") {
  struct Field final : SizeField {
    Point small_at;
    explicit Field(Point p) : small_at(p) {}
    double edge_length(const Point& p) const override {
      return std::hypot(p.x - small_at.x, p.y - small_at.y) < 0.1 ? 1 : 3;
    }
  };
  const Mesh mesh = one_triangle({0, 0}, {3, 0}, {0, 2});  // area 3; 0.433 and 3.9 are the bounds
  for (const Point small_at : {Point{0, 0}, Point{3, 0}, Point{0, 2}, Point{1, 2.0 / 3}}) {
    const Field field(small_at);
    VerifyOptions options;
    options.size = &field;
    CHECK(verify(mesh, options).findings.count(Flaw::kLargeArea) == 1);
  }
  const Field field({9, 9});
  VerifyOptions options;
  options.size = &field;
  CHECK(verify(mesh, options).accepted());
}

TEST_CASE(
    "sizes between the corners: at the field's marks, at samples of every triangle, and dense ones of a large one") {
  struct Field final : SizeField {
    Point center{};
    double radius = 0, inside = 0;
    std::vector<Point> marks;
    double edge_length(const Point& p) const override {
      return std::hypot(p.x - center.x, p.y - center.y) < radius ? inside : 3;
    }
    void visit_marks(const std::function<void(const Point&)>& visit) const override {
      for (const Point& p : marks) visit(p);
    }
  };
  const Mesh mesh = one_triangle({0, 0}, {3, 0}, {0, 2});  // the edge of an equilateral triangle is 2.632
  Field field;
  field.center = {0.5, 0.5};
  VerifyOptions options;
  options.size = &field;
  const auto flaws = [&](double radius, double inside) {
    field.radius = radius;
    field.inside = inside;
    return verify(mesh, options).findings.count(Flaw::kLargeArea);
  };
  CHECK(flaws(0.2, 3) == 0);
  CHECK(flaws(0.4, 1) == 1);
  CHECK(flaws(0.4, 2.1) == 1);  // 0.8 is tolerated
  CHECK(flaws(0.4, 2.11) == 0);
  CHECK(flaws(0.02, 1) == 0);
  options.size_spacing = 0.03;
  CHECK(flaws(0.02, 1) == 1);
  options.size_spacing = 0;
  field.marks = {{9, 9}, field.center};
  CHECK(flaws(0.02, 1) == 1);
  CHECK(flaws(1e-9, 2.63) == 1);  // nothing is tolerated at marks
  CHECK(flaws(1e-9, 2.64) == 0);
}

TEST_CASE("a small angle is accepted where the input has it, and nowhere else") {
  VerifyOptions options;
  options.min_angle = 20;
  Mesh wedge = one_triangle({0, 0}, {4, 0}, {4, 1});  // 14 degrees
  VerifyReport report = verify(wedge, options);
  CHECK(report.accepted());
  CHECK(report.quality.exceptions[ExceptionReason::kInputAngle].count == 1);

  // The same corner cut by a vertex: its two angles of 7 degrees are not angles of the input.
  Mesh cut;
  cut.points = {{0, 0}, {4, 0}, {4, 0.5}, {4, 1}};
  cut.triangles = {{0, 1, 2}, {0, 2, 3}};
  cut.edges = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 0, 1}};
  report = verify(cut, options);
  CHECK(report.findings.count(Flaw::kSmallAngle) == 2);
}

TEST_CASE("a skinny triangle on a seditious edge is accepted if its ends are equally far from the apex") {
  // Two segments from (0, 0) at 53 degrees with vertices p and q in their insides; the triangle p q r is skinny.
  const auto mesh = [](double distance_of_q) {
    Mesh m;
    const Point along{0.6, 0.8};
    m.points = {{0, 0}, {1, 0}, {9, 0}, {along.x * distance_of_q, along.y * distance_of_q}, {along.x * 9, along.y * 9}};
    m.triangles = {{0, 1, 3}, {1, 4, 3}, {1, 2, 4}};
    m.edges = {{0, 1, 1}, {1, 2, 1}, {0, 3, 2}, {3, 4, 2}, {2, 4, 3}};
    return m;
  };
  VerifyOptions options;
  options.min_angle = 20;
  options.check_delaunay = false;
  VerifyReport report = verify(mesh(1), options);
  CHECK(report.accepted());
  CHECK(report.quality.exceptions[ExceptionReason::kSmallWedge].count == 1);
  CHECK(report.quality.exception_count() == 1);
  report = verify(mesh(1.01), options);
  CHECK(report.findings.count(Flaw::kSmallAngle) == 1);
}

TEST_CASE("chains end at corners, at forks and at bends") {
  Mesh mesh;
  mesh.points = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {3, 1}};
  const Subsegments subsegments(mesh.points.size(), {{0, 1, 0}, {2, 1, 0}, {2, 3, 0}, {3, 4, 0}, {3, 5, 0}});
  const Chains plain(mesh, subsegments, [](std::int32_t) { return false; });
  CHECK(plain.all().size() == 3);
  CHECK(plain.all()[0].vertices == std::vector<std::int32_t>{0, 1, 2, 3});
  CHECK(plain.through(1) == 0);
  CHECK(plain.through(3) == kNone);
  const Chains cut(mesh, subsegments, [](std::int32_t v) { return v == 2; });
  CHECK(cut.all().size() == 4);
  CHECK(!bends_at(mesh, subsegments, 1));
  CHECK(bends_at(mesh, subsegments, 3));
  const Subsegments loop(mesh.points.size(), {{0, 3, 0}, {3, 5, 0}, {5, 0, 0}});
  const Chains ring(mesh, loop, [](std::int32_t) { return false; });
  CHECK(ring.all().size() == 1);
  CHECK(ring.all()[0].vertices.size() == 4);
}

TEST_CASE("the report names counts, exceptions and flaws, and ends in a verdict of one line") {
  VerifyOptions options;
  options.min_angle = 20;
  options.plain.area = 1;
  const VerifyReport report =
      verify(one_triangle({0, 0}, {4, 0}, {4, 1}), options);  // area 2, smallest angle 14 degrees
  const std::string text = report_text(report, options);
  CHECK(text.find("exceptions     1 triangles that miss a bound, as the input explains") != std::string::npos);
  CHECK(text.find("small angle of the input: 1") != std::string::npos);
  CHECK(text.find("large area: 1\n    triangle 0 (0 1 2) has area 2, at most 1 is allowed") != std::string::npos);
  CHECK(verdict_text(report, options) == "rejected: large area (1)");
  options.plain.area = 0;
  CHECK(verdict_text(verify(one_triangle({0, 0}, {4, 0}, {4, 1}), options), options) ==
        "accepted: constrained Delaunay, angles of at least 20 degrees except for 1 triangles that the input explains");
}

TEST_CASE("a skinny triangle is accepted next to a segment that doubles cannot split, and nowhere else") {
  // From 2 on the spacing of doubles is e. The segment ab has c on one side, `gap` spacings off, and on the other the
  // triangle abq with an angle of 5.6 degrees at b, whose off-center lies in the diametral circle of ab.
  const double e = 0x1p-51;
  const auto excused = [&](double gap, bool c_on_segments) {
    const auto at = [&](double x, double y) { return Point{2 + x * e, 1 + y * e}; };
    Mesh m;
    m.points = {at(0, 0), at(0, 1024), at(-100, 0), at(gap, 512), at(-1024, 512)};  // a, b, q, c
    m.triangles = {{0, 1, 2}, {0, 3, 1}, {1, 4, 2}};
    m.edges = {{0, 1, 1}, {1, 4, 1}, {4, 2, 1}, {2, 0, 1}};
    if (c_on_segments) m.edges.insert(m.edges.end(), {{0, 3, 1}, {3, 1, 1}});
    VerifyOptions options;
    options.min_angle = 20;
    options.check_delaunay = false;
    return verify(m, options).quality.exceptions[ExceptionReason::kNoRoom].count;
  };
  CHECK(excused(1, true) == 1);
  CHECK(excused(1, false) == 0);
  CHECK(excused(4, true) == 0);
  CHECK(excused(600, true) == 0);
}
