#include <doctest/doctest.h>

#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "driftmesh/driftmesh.hpp"
#include "support/error_text.hpp"

// Rules for target edge lengths in a program that uses the library.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

const Pslg& square() {
  static const Pslg pslg = [] {
    Pslg made;
    made.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    made.segments = {{0, 1, 1}, {1, 2, 2}, {2, 3, 3}, {3, 0, 4}};
    return made;
  }();
  return pslg;
}

std::vector<Point> points_of(const SizeRule& rule) {
  return mesh(square(), {.size = rule}).points;
}

/// x + 2 y at 3 x 4 points, every way around.
GridValues plane(bool from_east, bool from_north) {
  GridValues grid{.columns = 3, .x0 = from_east ? 1.0 : 0.0, .y0 = from_north ? 1.0 : 0.0};
  grid.dx = from_east ? -0.5 : 0.5;
  grid.dy = from_north ? -1.0 / 3 : 1.0 / 3;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 3; ++i)
      grid.values.push_back(static_cast<float>(grid.x0 + i * grid.dx + 2 * (grid.y0 + j * grid.dy)));
  return grid;
}

}  // namespace

TEST_CASE("rules are formulas of their parts") {
  const SizeRule x = SizeRule::expression("x"), rule = (0.5 + 2 * x - x / 4) * 2;
  CHECK(rule({4, 0}) == doctest::Approx(15));
  CHECK(min(x, 3)({4, 0}) == 3);
  CHECK(max(x, SizeRule::expression("y"))({4, 5}) == 5);
  CHECK(SizeRule(2.5)({7, 7}) == 2.5);
  CHECK(std::isinf(SizeRule(std::numeric_limits<double>::infinity())({0, 0})));
  CHECK(SizeRule::expression("max(a, b2) - a", {{"a", 1}, {"b2", 3 * x}})({4, 0}) == doctest::Approx(11));
  CHECK(rule.limited({.shortest = 20})({4, 0}) == 20);
  CHECK((x - 5).limited({.shortest = 0.25, .longest = 1})({4, 0}) == 0.25);
}

TEST_CASE("a mesh by a rule is that by the same expression") {
  const std::string formula = "0.02 + 0.1*distance(1)";
  const SizeRule rule = 0.02 + 0.1 * SizeRule::distance({1});
  CHECK(points_of(rule) == points_of(SizeRule::expression(formula)));
  const std::vector<Point> coarse = points_of(2 * rule);
  CHECK(coarse.size() < points_of(rule).size() / 2);
  CHECK(check(mesh(square(), {.size = rule}), square(), {.size = rule}).accepted);
  CHECK(!check(mesh(square(), {.size = 2 * rule}), square(), {.size = rule}).accepted);
  const MeshOptions one{.size = rule, .threads = 1}, three{.size = rule, .threads = 3};
  CHECK(mesh(square(), one).points == mesh(square(), three).points);
  CHECK(points_of(SizeRule::width() / 5).size() > 30);
  CHECK(points_of(SizeRule::distance_to({{Point{0, 0}, Point{1, 0}}}) + 0.05) ==
        points_of(SizeRule::distance({1}) + 0.05));
}

TEST_CASE("growth is limited in all of a rule") {
  const SizeRule jump = SizeRule::expression("x < 0.1 ? 0.01 : 1");
  const std::size_t graded = points_of(jump.limited({.gradation = 0.2})).size();
  CHECK(graded > 1.3 * static_cast<double>(points_of(jump).size()));
  CHECK(error_text([&] { (void)(jump.limited({.gradation = 0.2}) + 1); }).find("limit the whole") != std::string::npos);
}

TEST_CASE("rasters lie where they are placed, and gaps are filled") {
  for (const bool from_east : {false, true})
    for (const bool from_north : {false, true}) {
      GridValues grid = plane(from_east, from_north);
      const SizeRule rule = SizeRule::raster(grid);
      CHECK(rule({0.3, 0.7}) == doctest::Approx(1.7));
      CHECK(rule({3, -7}) == doctest::Approx(1));
      CHECK(SizeRule::slope(grid)({0.4, 0.6}) == doctest::Approx(std::sqrt(5.0)));
      CHECK(SizeRule::expression("depth + slope(depth)", {{"depth", rule}})({0.5, 0.5}) ==
            doctest::Approx(1.5 + std::sqrt(5.0)));
      grid.values[4] = std::nanf("");
      CHECK(std::isfinite(SizeRule::raster(grid)({0.5, 0.4})));
    }
}

TEST_CASE("lengths at the points of a mesh are a rule among others") {
  const Mesh last = mesh(square(), {.max_area = 0.01});
  std::vector<double> lengths;
  for (const Point& p : last.points) lengths.push_back(0.05 + 0.1 * p.x);
  const SizeRule rule = SizeRule::on_mesh(last, lengths);
  CHECK(rule({0.5, 0.5}) == doctest::Approx(0.1));
  CHECK(points_of(min(rule, 0.06)).size() > points_of(rule).size());
  CHECK(check(mesh(square(), {.size = rule}), square(), {.size = rule}).accepted);
}

TEST_CASE("a function of the caller is asked by the calling thread alone, unless more are asked for") {
  std::atomic<int> elsewhere{0};
  const std::thread::id here = std::this_thread::get_id();
  const SizeRule rule = SizeRule::function([&](const Point& p) {
    elsewhere += std::this_thread::get_id() != here;
    return p.x < 0 || p.x > 1 ? std::nan("") : 0.003 + 0.01 * p.x;
  });
  const MeshOptions options{.size = 0.5 * rule, .size_resolution = 50, .subdomains = {.count = 8}};
  const Mesh made = mesh(square(), options);
  CHECK(elsewhere == 0);
  CHECK(made.points.size() > 1000);
}

TEST_CASE("what can be no part of a rule is refused") {
  const auto refused = [](const std::function<void()>& call, const std::string& word) {
    const std::string text = error_text(call);
    CAPTURE(text);
    CHECK(text.find(word) != std::string::npos);
  };
  refused([] { (void)SizeRule(std::nan("")); }, "NaN");
  refused([] { (void)SizeRule::distance_to({}); }, "no segments");
  refused([] { (void)SizeRule::raster({.values = {1, 2, 3}, .columns = 2}); }, "full rows");
  refused([] { (void)SizeRule::raster({.values = {1, 2, 3, 4}, .columns = 2, .dx = 0}); }, "spacings");
  refused([] { (void)SizeRule::expression("a", {{"x", 1}}); }, "'x'");
  refused([] { (void)points_of(SizeRule::expression("sqr(x)")); }, "sqr");
  refused([] { (void)points_of(SizeRule::expression("x - 0.5")); }, "positive");
  refused([] { (void)SizeRule::distance()({0, 0}); }, "segments");
  refused([] { (void)SizeRule(1).limited({.shortest = 2, .longest = 1}); }, "limits");
  refused([] { (void)SizeRule::function({}); }, "empty function");
}
