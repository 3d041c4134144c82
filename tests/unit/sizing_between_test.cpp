#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "driftmesh/error.hpp"
#include "sizing/background_function.hpp"
#include "sizing/expression.hpp"
#include "sizing/expression_field.hpp"
#include "sizing/limited_function.hpp"
#include "sizing/make_size_field.hpp"
#include "sizing/sampled_field.hpp"
#include "sizing/size_tree.hpp"
#include "sizing/uniform_field.hpp"
#include "support/infinity.hpp"
#include "unit/sizing_mesh_fixture.hpp"

// What size fields know of a triangle between its corners.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

constexpr std::array<Point, 3> kHalfSquare{{{0, 0}, {1, 0}, {1, 1}}};

Interval range_of(const std::string& expression, const Box& box) {
  return Expression(expression).over(box).value;
}

void check_range(const std::string& expression, double low, double high) {
  CAPTURE(expression);
  const Interval range = range_of(expression, {{-1, 2}, {3, 4}});
  CHECK((range.low == low || range.low == doctest::Approx(low)));
  CHECK((range.high == high || range.high == doctest::Approx(high)));
}

/// As it is compiled for meshes of a domain.
std::unique_ptr<SizeField> compiled(const std::string& expression, const Box& domain = {{0, 0}, {1, 1}}) {
  return make_size_field(
      {.expression = expression, .spacing = (domain.high.x - domain.low.x) / 2000, .domain = domain});
}

/// A field that counts how often it is asked.
struct Counted final : SizeField {
  mutable int calls = 0;
  [[nodiscard]] double edge_length(const Point&) const override {
    ++calls;
    return 1;
  }
};

}  // namespace

TEST_CASE("the range of an expression over a box") {
  check_range("x", -1, 3);
  check_range("2 - 3*x", -7, 5);
  check_range("x^2", 0, 9);
  check_range("-x^2", -9, 0);
  check_range("2^-x", 0.125, 2);
  check_range("y^x^1", 0.25, 64);
  check_range("x*y", -4, 12);
  check_range("1/y", 0.25, 0.5);
  check_range("1/x", -kInfinity, kInfinity);
  check_range("abs(x) + hypot(x, y)", 2, 8);
  check_range("asinh(x)", std::asinh(-1), std::asinh(3));
  check_range("acosh(y)", std::acosh(2), std::acosh(4));
  check_range("acosh(x)", -kInfinity, kInfinity);
  check_range("atanh(x/4)", std::atanh(-0.25), std::atanh(0.75));
  check_range("atanh(x)", -kInfinity, kInfinity);
  check_range("sqrt(y)", std::sqrt(2.0), 2);
  check_range("sqrt(x)", -kInfinity, kInfinity);
  check_range("exp(-x^2)", std::exp(-9), 1);
  check_range("sin(x)", std::sin(-1.0), 1);
  check_range("cos(x)", std::cos(3.0), 1);
  check_range("min(x, y, 1)", -1, 1);
  check_range("avg(x, y)", 0.5, 3.5);
  check_range("x < -2 ? 7 : y", 2, 4);
  check_range("x < 0 && y > 1 ? 7 : y", 2, 7);
  check_range("y >= 2 || x > 9 ? 7 : y", 7, 7);
  CHECK(range_of("0.1 + exp(x)", {{-kInfinity, 0}, {kInfinity, 0}}).low == doctest::Approx(0.1));
}

TEST_CASE("what may be NaN widens the range of operations that a number can leave again") {
  const Box box{{-2, 2}, {-1, 4}};
  const std::string nan = "cos(sqrt(x))";  // otherwise from -1 to 1
  CHECK(range_of("max(-5, " + nan + ")", box).low == -5);
  CHECK(range_of("min(5, " + nan + ")", box).high == 5);
  CHECK(range_of("sign(2 + " + nan + ")", box).low <= 0);
  CHECK(range_of(nan + " < 7", box) == Interval{0, 1});
  CHECK(range_of("max(20, 3*sqrt(9.81*x))", box).low == doctest::Approx(20));
}

TEST_CASE("what overflows on the way does not hide values that do not") {
  const Expression tiny("x^-1030");
  const double value = tiny.at({2, 0});
  CHECK(value > 0);
  CHECK(tiny.over({{2, 0}, {2, 0}}).value.holds(value));
}

TEST_CASE("an expression falls below a length where it does, however narrow the place") {
  const auto bump = compiled("0.3 - 0.29*exp(-((x-0.6)^2 + (y-0.3)^2)*1e12)");
  CHECK(bump->falls_below(kHalfSquare, 0.2));
  CHECK(bump->falls_below(kHalfSquare, 0.02));
  CHECK(!bump->falls_below(kHalfSquare, 0.0111));  // a tenth more than its least
  CHECK(!bump->falls_below({{{0, 0}, {0.5, 1}, {0, 1}}}, 0.2));
  const auto crease = compiled("1e-4 + 10*abs(y - 0.3)");
  CHECK(crease->falls_below(kHalfSquare, 1e-2));
  CHECK(!crease->falls_below(kHalfSquare, 1e-4));
  CHECK(!crease->falls_below({{{0, 0}, {0.2, 0}, {0.2, 0.2}}}, 0.9));
}

TEST_CASE("squares end where coordinates have no digits left") {
  const Box domain{{1e6 - 1e-9, 1e6 - 1e-9}, {1e6 + 2e-9, 1e6 + 2e-9}};
  const std::array<Point, 3> tiny{{{1e6, 1e6 - 1e-9}, {1e6 + 2e-9, 1e6 - 1e-9}, {1e6, 1e6 + 1e-9}}};
  CHECK(compiled("1e-30 + abs(y - 1e6)", domain)->falls_below(tiny, 1e-9));
  CHECK(!compiled("2e-9 + abs(y - 1e6)", domain)->falls_below(tiny, 1e-9));
}

TEST_CASE("lengths are close to those of the expression, and exact where it is linear") {
  const std::string expression = "0.1 + 0.2*(x - 0.3)^2 + 0.1*abs(y - 0.4)";
  const auto field = compiled(expression), linear = compiled("0.125 + 0.5*x + 0.25*y");
  const ExpressionField exact(expression);
  for (int i = 0; i < 400; ++i) {
    const Point p{0.0024 * i, 0.03 * (i % 33)};
    CHECK(field->edge_length(p) == doctest::Approx(exact.edge_length(p)).epsilon(0.12));
    CHECK(linear->edge_length(p) == doctest::Approx(0.125 + 0.5 * p.x + 0.25 * p.y).epsilon(1e-6));
  }
  CHECK(compiled("0.25")->edge_length({0.7, 0.1}) == 0.25);
  CHECK(std::isinf(compiled("x < 0.25 ? 0.25 : 1/0")->edge_length({0.7, 0.1})));
}

TEST_CASE("a point where an expression is no length is named, wherever the squares end") {
  const auto field = compiled("x - 0.5");
  CHECK(field->edge_length({0.75, 0.5}) == doctest::Approx(0.25));
  CHECK_THROWS_AS((void)field->edge_length({0.25, 0.5}), InputError);
  CHECK_THROWS_AS((void)field->edge_length({0.5, 0.5}), InputError);
  CHECK_THROWS_AS((void)compiled("sqrt(x - 0.5)")->edge_length({0.25, 0.5}), InputError);
  CHECK(compiled("max(0.1, sqrt(x - 0.5))")->edge_length({0.25, 0.5}) == doctest::Approx(0.1));
}

TEST_CASE("what an expression cannot fall below between the corners is known in short where it grows slowly") {
  const auto slow = compiled("0.1 + 0.02*x"), fast = compiled("0.1 + 3*abs(x - 0.5)");
  const std::array<Point, 3> small{{{0.5, 0.5}, {0.6, 0.5}, {0.5, 0.6}}};
  CHECK(slow->least_between(small, 0.11) == 0.11);
  CHECK(fast->least_between({{{0.4, 0.4}, {0.6, 0.4}, {0.6, 0.6}}}, 0.4) < 0.4);
}

TEST_CASE("a constant is known not to fall anywhere") {
  CHECK(compiled("0.25 + 0*x")->least() == doctest::Approx(0.25));
  CHECK(compiled("max(x, 0.125)")->least() == 0.125);
  CHECK(compiled("x")->least() == 0);
  CHECK(UniformField(3).least() == 3);
}

TEST_CASE("the least of functions falls where one of them does, but not below the shortest length") {
  const auto field = [](double shortest) {
    const auto crease = std::make_shared<const Expression>("0.001 + abs(y - 0.3)");
    const auto flat = std::make_shared<const Expression>("0.5");
    return std::make_unique<SizeTree>(nullptr, limited(least_of({flat, crease}), shortest, kInfinity),
                                      Box{{0, 0}, {1, 1}}, 1.0 / 2000, SizeTree::Rules{});
  };
  CHECK(field(1e-6)->falls_below(kHalfSquare, 0.01));
  CHECK(!field(0.02)->falls_below(kHalfSquare, 0.01));
  CHECK(field(0.02)->least() == 0.02);
  CHECK(field(1e-6)->edge_length({0.5, 0.9}) == doctest::Approx(0.5).epsilon(0.12));
  const auto nan = std::make_shared<const Expression>("sqrt(x - 0.5)"), one = std::make_shared<const Expression>("1");
  for (const auto& both : {least_of({nan, one}), least_of({one, nan})}) {
    CHECK(std::isnan(both->at({0.25, 0})));
    CHECK(both->over({{0, 0}, {1, 1}}).value.undefined);
    CHECK(both->at({0.75, 0}) == 0.5);
  }
}

TEST_CASE("a sampled field asks once for each point of its grid, and for none outside the triangle") {
  const Counted counted;
  const SampledField field(counted, {{0, 0}, 1.0 / 128});
  CHECK(!field.falls_below(kHalfSquare, 0.5));
  CHECK(counted.calls == 129 * 130 / 2);
  CHECK(!field.falls_below(kHalfSquare, 0.5));
  CHECK(counted.calls == 129 * 130 / 2);
  CHECK(field.falls_below(kHalfSquare, 1.2));
}

TEST_CASE("a sampled field is searched between the points of its grid where it is steep") {
  const auto crease = [](double slope) {
    return std::make_unique<ExpressionField>("0.001 + " + std::to_string(slope) + "*abs(y - 0.5031)");
  };
  const SampledField steep(crease(20), {{0, 0}, 1.0 / 64});
  const std::array<Point, 3> across{{{-0.005, 0}, {1, 0}, {-0.005, 1}}};
  CHECK(steep.falls_below(across, 0.01));
  CHECK(!steep.falls_below(across, 0.0005));
}

TEST_CASE("lengths of a background mesh are found at its points and along its edges") {
  // A square with a short length in the middle, and one at a corner.
  const std::vector<Point> points{{0, 0}, {4, 0}, {4, 4}, {0, 4}, {2, 2}};
  const auto mesh = std::make_shared<const BackgroundMesh>(
      points, std::vector<BackgroundMesh::Triangle>{{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}});
  const SizeTree field(nullptr, BackgroundFunction::of_points(mesh, {1, 5, 5, 5, 2}), {{0, 0}, {4, 4}}, 0.002,
                       SizeTree::Rules{});
  const std::array<Point, 3> around{{{1, 1.5}, {3, 1.5}, {2, 3}}};
  CHECK(field.falls_below(around, 2 * 1.26));
  CHECK(!field.falls_below(around, 1.2));
  // Crosses the edge from the corner to the middle, where it holds 1.25 to 1.75: neither is a point inside.
  const std::array<Point, 3> across{{{1.5, 0.5}, {1.6, 0.6}, {0.5, 1.6}}};
  CHECK(field.falls_below(across, 1.54 * 1.26));
  CHECK(!field.falls_below(across, 1.4));
}

TEST_CASE("area bounds hold in triangles that overlap theirs, but not in those that touch it") {
  const std::vector<Point> points{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  const auto mesh =
      std::make_shared<const BackgroundMesh>(points, std::vector<BackgroundMesh::Triangle>{{0, 1, 2}, {0, 2, 3}});
  const SizeTree field(nullptr, BackgroundFunction::of_areas(mesh, {std::sqrt(3.0) / 4, -1}), {{0, 0}, {4, 4}}, 0.002,
                       SizeTree::Rules{});
  CHECK(!field.falls_below({{{0, 3}, {2.5, 3.9}, {1, 3.9}}}, 2));
  CHECK(field.falls_below({{{1.9, 1.8}, {3, 3.5}, {0, 3.9}}}, 1.26));
  CHECK(!field.falls_below({{{1.9, 1.8}, {3, 3.5}, {0, 3.9}}}, 0.99));
}

TEST_CASE("what a background mesh does not cover") {
  const FlatMesh whole = square_mesh(8), with_hole = square_mesh(8, 2);
  const std::array<Point, 3> across{{{0, 0}, {8, 0}, {4, 8}}};
  const BackgroundMesh solid(whole.points, whole.triangles), ring(with_hole.points, with_hole.triangles);
  CHECK(solid.covers(across));
  CHECK(solid.covers(Box{{0, 0}, {8, 8}}));
  CHECK(!solid.covers(Box{{0, 0}, {8, 9}}));
  CHECK(!solid.covers(std::array<Point, 3>{{{0, 0}, {9, 1}, {0, 1}}}));
  CHECK(!ring.covers(across));
  const std::optional<Point> place = ring.uncovered(across);
  REQUIRE(place);
  CHECK(Box{{3, 3}, {5, 5}}.contains(*place));
  CHECK(ring.covers(std::array<Point, 3>{{{0, 0}, {8, 0}, {0, 3}}}));
}
