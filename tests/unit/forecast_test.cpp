#include "mesh/forecast.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "driftmesh/generate.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/cdt.hpp"
#include "mesh/refiner.hpp"
#include "small_domains.hpp"
#include "support/prepared_mesh.hpp"

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

QualityBounds bounds_with(double angle, double area) {
  QualityBounds bounds;
  bounds.min_angle = angle;
  bounds.plain.area = area;
  return bounds;
}

template <class Move>
Pslg moved(Pslg pslg, Move&& move) {
  for (Point& p : pslg.points) p = move(p);
  for (Point& p : pslg.holes) p = move(p);
  return pslg;
}

/// grown_from by brute force: squares of a fine grid of barycentric coordinates.
Covered by_grid(const CornerPoints& t, double size, double reach, const Growth& growth) {
  constexpr int kCells = 1500;
  const double cell = signed_area(t[0], t[1], t[2]) / (kCells * kCells);
  Covered sum;
  for (int i = 0; i < kCells; ++i)
    for (int j = 0; i + j < kCells; ++j)
      for (const double third : {1.0 / 3, 2.0 / 3}) {
        if (third > 0.5 && i + j == kCells - 1) continue;
        const double u = (i + third) / kCells, v = (j + third) / kCells;
        const double r =
            std::hypot(u * (t[1].x - t[0].x) + v * (t[2].x - t[0].x), u * (t[1].y - t[0].y) + v * (t[2].y - t[0].y));
        if (r > reach) continue;
        sum += {growth.density * cell / std::pow(size + growth.slope * r, 2), cell};
      }
  return sum;
}

Covered by_formula(const CornerPoints& t, double size, double reach, const Growth& growth) {
  const double ab = std::sqrt(squared_distance(t[0], t[1])), ac = std::sqrt(squared_distance(t[0], t[2]));
  const double bc = std::sqrt(squared_distance(t[1], t[2]));
  return grown_from({angle_at(t[1], t[0], t[2]), std::min(ab, ac), std::max(ab, ac), bc, signed_area(t[0], t[1], t[2])},
                    size, reach, growth);
}

}  // namespace

TEST_CASE("closed forms of what grows from a corner agree with sums over a grid") {
  const Growth growth{1.3, 0.7};
  const std::vector<CornerPoints> triangles = {{{{0, 0}, {1, 0}, {0.5, 0.87}}},   {{{0, 0}, {10, 0}, {0, 1}}},
                                               {{{0, 0}, {10, -0.5}, {10, 0.5}}}, {{{0, 0}, {5, 0}, {-2, 3}}},
                                               {{{0, 0}, {3, 0}, {3, 0.4}}},      {{{0, 0}, {2, -0.3}, {-2, -0.2}}}};
  for (const CornerPoints& t : triangles) {
    const CornerPoints upright = signed_area(t[0], t[1], t[2]) > 0 ? t : CornerPoints{t[0], t[2], t[1]};
    for (const double size : {0.1, 1.0})
      for (const double reach : {kNoBound, 1.5}) {
        CAPTURE(upright[1].x);
        CAPTURE(size);
        CAPTURE(reach);
        const Covered grid = by_grid(upright, size, reach, growth), formula = by_formula(upright, size, reach, growth);
        CHECK(formula.triangles == doctest::Approx(grid.triangles).epsilon(0.15));
        CHECK(formula.area == doctest::Approx(grid.area).epsilon(0.25));
      }
  }
  const CornerPoints any{{{0, 0}, {1, 0}, {0, 1}}};
  CHECK(by_formula(any, 1, 0, growth).triangles == 0);
  CHECK(by_formula(any, 1, -1, growth).area == 0);
}

TEST_CASE("integrals over strips and lines agree with sums, also where sizes hardly change") {
  for (const double end : {1.0, 1.0000001, 1.0009, 1.0011, 0.5, 7.0, 1e6}) {
    CAPTURE(end);
    constexpr int kSteps = 2'000'000;
    double strip = 0, line = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double x = (i + 0.5) / kSteps, size = 1 + x * (end - 1);
      strip += (3 - 2 * x) / (size * size) / kSteps;
      line += 1 / size / kSteps;
    }
    CHECK(integrate_strip(1, 3, 1, 1, end) == doctest::Approx(strip).epsilon(1e-4));
    CHECK(integrate_line(1, 1, end) == doctest::Approx(line).epsilon(1e-4));
    CHECK(integrate_line(1, end, 1) == doctest::Approx(line).epsilon(1e-4));
  }
}

TEST_CASE("larger angle bounds let sizes grow more slowly") {
  for (double angle = 1; angle <= kMaxAngle; angle += 0.25) {
    CAPTURE(angle);
    const Growth less = growth_of(angle - 0.25), more = growth_of(angle);
    CHECK(more.slope <= less.slope);
    CHECK(more.density / more.slope >= less.density / less.slope);  // along a line
    CHECK(more.slope > 0);
  }
}

TEST_CASE("the forecast is the same at every scale and in every position") {
  BayOptions bay;
  bay.resolution = 1500;
  for (const Pslg& pslg : {generate_bay(bay), fan(5, 12), generate_comb({})}) {
    for (const double angle : {0.0, 20.0, 33.0}) {
      CAPTURE(angle);
      const double forecast = forecast_triangles(prepared(pslg), bounds_with(angle, 0));
      for (const double scale : {0x1p-60, 0x1p20}) {
        const Pslg scaled = moved(pslg, [&](Point p) { return Point{scale * p.x, scale * p.y}; });
        CHECK(forecast_triangles(prepared(scaled), bounds_with(angle, 0)) == forecast);
      }
      const auto turn = [](Point p) { return Point{0.8 * p.x - 0.6 * p.y + 3, 0.6 * p.x + 0.8 * p.y - 7}; };
      CHECK(forecast_triangles(prepared(moved(pslg, turn)), bounds_with(angle, 0)) ==
            doctest::Approx(forecast).epsilon(0.05));
    }
  }
}

TEST_CASE("without any bound, the mesh is the triangulation as it is") {
  const Triangulation mesh = prepared(fan(3, 9));
  CHECK(forecast_triangles(mesh, bounds_with(0, 0)) == static_cast<double>(mesh.live_triangles()));
}

TEST_CASE("a triangulation that meets the angle bound is not refined") {
  RandomPolygonOptions labyrinth;  // its triangles are right-angled
  labyrinth.jitter = 0;
  const Triangulation mesh = prepared(generate_random_polygon(labyrinth));
  CHECK(forecast_triangles(mesh, bounds_with(30, 0)) == static_cast<double>(mesh.live_triangles()));
}

TEST_CASE("a channel has as many triangles as its length needs") {
  for (const double length : {10.0, 50.0, 400.0}) {
    CAPTURE(length);
    Triangulation mesh = prepared(rectangle(length, 1));
    const QualityBounds bounds = bounds_with(20, 0);
    const double forecast = forecast_triangles(mesh, bounds);
    CHECK(Refiner(mesh, bounds).refine() == Refiner::Status::kDone);
    CHECK(forecast / static_cast<double>(mesh.live_triangles()) > 0.5);
    CHECK(forecast / static_cast<double>(mesh.live_triangles()) < 2);
  }
}

TEST_CASE("bounds on area decide where they ask for more than the details do") {
  const Triangulation mesh = prepared(rectangle(2, 1));
  CHECK(forecast_triangles(mesh, bounds_with(20, 1e-6)) == doctest::Approx(1.55 * 2e6).epsilon(0.01));
  const Triangulation bay = prepared(generate_bay({}));
  const double by_angle = forecast_triangles(bay, bounds_with(20, 0));
  double last = by_angle;
  for (const double area : {1e8, 1e6, 1e5, 1e4}) {  // square meters, of 5e9
    const double forecast = forecast_triangles(bay, bounds_with(20, area));
    CHECK(forecast >= 0.95 * last);
    CHECK(forecast <= by_angle + 1.1 * BoundForecast(bay, bounds_with(20, area)).total());
    last = forecast;
  }
}

TEST_CASE("the forecast of a large input, which leaves triangles out, is about the sum over all of them") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(0.001, 0.999);
  Pslg pslg;
  pslg.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  pslg.segments = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 0, 1}};
  for (int k = 0; k < 18'000; ++k) pslg.points.push_back({place(random), place(random)});
  const Triangulation mesh = prepared(pslg);
  REQUIRE(mesh.live_triangles() > 32'000);
  for (const double area : {0.0, 1e-5}) {
    const Forecast forecast(mesh, bounds_with(20, area));
    double sum = 0;
    for (const TriangleId t : ids_of(mesh.triangles))
      if (mesh.triangles[t].alive()) sum += forecast.in(t);
    CHECK(sum > 1.2 * static_cast<double>(mesh.live_triangles()));
    CHECK(forecast.total() == doctest::Approx(sum).epsilon(0.05));
  }
}

TEST_CASE("samples stand for all triangles, for about as many each, where these will be") {
  BayOptions options;
  options.resolution = 500;
  const Triangulation mesh = prepared(generate_bay(options));
  for (const double area : {0.0, 1e6}) {
    const QualityBounds bounds = bounds_with(20, area);
    const Forecast forecast(mesh, bounds);
    double sum = 0, most = 0, east = 0;
    constexpr double kQuota = 10;
    forecast.visit_samples(kQuota, [&](const Point& at, double triangles) {
      sum += triangles;
      most = std::max(most, triangles);
      if (at.x > options.width / 2) east += triangles;
    });
    CHECK(sum == doctest::Approx(forecast.total()).epsilon(1e-6));
    CHECK(most <= 2 * kQuota);
    Triangulation refined = mesh;
    Refiner(refined, bounds).refine();
    double real_east = 0;
    for (const TriangleId t : ids_of(refined.triangles))
      if (refined.triangles[t].alive() &&
          centroid({refined.corner(t, 0), refined.corner(t, 1), refined.corner(t, 2)}).x > options.width / 2)
        ++real_east;
    CHECK(east / sum == doctest::Approx(real_east / static_cast<double>(refined.live_triangles())).epsilon(0.1));
  }
}
