#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "job/domain.hpp"
#include "property/cases.hpp"
#include "raster/greatest_in_triangle.hpp"
#include "support/made_mesh.hpp"
#include "support/random.hpp"
#include "temporary_folder.hpp"
#include "verify/report_text.hpp"
#include "verify/verify.hpp"

// Meshes that are to allow a time step, against an evaluation of depths and Courant numbers from the raw numbers.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

/// Depths at points of a grid, row by row from below.
struct Depths {
  RasterFrame frame;
  std::vector<float> values;

  [[nodiscard]] double value(std::int64_t i, std::int64_t j) const {
    return values[static_cast<std::size_t>(j * frame.columns + i)];
  }
  /// By the four products of the textbook.
  [[nodiscard]] double at(const Point& p) const {
    const double u = std::clamp((p.x - frame.first.x) / frame.dx, 0.0, static_cast<double>(frame.columns - 1)),
                 v = std::clamp((p.y - frame.first.y) / frame.dy, 0.0, static_cast<double>(frame.rows - 1));
    const auto i = std::min(static_cast<std::int64_t>(u), frame.columns - 2),
               j = std::min(static_cast<std::int64_t>(v), frame.rows - 2);
    const double s = u - static_cast<double>(i), t = v - static_cast<double>(j);
    return (1 - s) * (1 - t) * value(i, j) + s * (1 - t) * value(i + 1, j) + (1 - s) * t * value(i, j + 1) +
           s * t * value(i + 1, j + 1);
  }
};

Depths random_depths(Random& random, const Box& box, std::int64_t most) {
  const auto count = [&] { return 2 + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(most)); };
  Depths depths;
  depths.frame = {count(), count(), box.low, 0, 0};
  depths.frame.dx = (box.high.x - box.low.x) / static_cast<double>(depths.frame.columns - 1);
  depths.frame.dy = (box.high.y - box.low.y) / static_cast<double>(depths.frame.rows - 1);
  const double deepest = std::exp2(uniform(random, 1, 6));
  for (std::int64_t k = 0; k < depths.frame.columns * depths.frame.rows; ++k)
    depths.values.push_back(static_cast<float>(uniform(random, -2, deepest)));
  return depths;
}

using Polygon = std::vector<Point>;

/// The part of a convex polygon where side(p) >= 0, which is linear.
template <class Side>
Polygon clipped(const Polygon& polygon, const Side& side) {
  Polygon kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Point &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    const double at_a = side(a), at_b = side(b);
    if (at_a >= 0) kept.push_back(a);
    if ((at_a < 0) != (at_b < 0)) {
      const double t = at_a / (at_a - at_b);
      kept.push_back({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)});
    }
  }
  return kept;
}

/// The greatest depth in a triangle, found cell by cell: on the border of what the triangle has of the cell. In cells
/// outside of the grid, which have no end, depths do not change across its rim.
double greatest_by_cells(const Depths& depths, const CornerPoints& triangle) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  const RasterFrame& f = depths.frame;
  double greatest = -kFar;
  const auto line = [](std::int64_t k, double first, double spacing, std::int64_t count) {
    return k < 0 ? -kFar : k >= count ? kFar : first + static_cast<double>(k) * spacing;
  };
  const Box box = Box::of(triangle);
  for (std::int64_t j = -1; j < f.rows; ++j) {
    const double south = line(j, f.first.y, f.dy, f.rows), north = line(j + 1, f.first.y, f.dy, f.rows);
    if (south > box.high.y || north < box.low.y) continue;
    for (std::int64_t i = -1; i < f.columns; ++i) {
      const double west = line(i, f.first.x, f.dx, f.columns), east = line(i + 1, f.first.x, f.dx, f.columns);
      if (west > box.high.x || east < box.low.x) continue;
      Polygon part(triangle.begin(), triangle.end());
      if (i >= 0) part = clipped(part, [&](const Point& p) { return p.x - west; });
      if (i + 1 < f.columns) part = clipped(part, [&](const Point& p) { return east - p.x; });
      if (j >= 0) part = clipped(part, [&](const Point& p) { return p.y - south; });
      if (j + 1 < f.rows) part = clipped(part, [&](const Point& p) { return north - p.y; });
      constexpr int kSteps = 64;
      for (std::size_t k = 0; k < part.size(); ++k)
        for (int n = 0; n <= kSteps; ++n) {
          const Point &a = part[k], &b = part[(k + 1) % part.size()];
          const double t = static_cast<double>(n) / kSteps;
          greatest = std::max(greatest, depths.at({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)}));
        }
    }
  }
  return greatest;
}

double length_of(const CornerPoints& t, CourantLength which) {
  double shortest = std::numeric_limits<double>::infinity(), longest = 0;
  for (const std::size_t k : {0, 1, 2}) {
    const double length = std::hypot(t[(k + 1) % 3].x - t[k].x, t[(k + 1) % 3].y - t[k].y);
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
  }
  if (which == CourantLength::kEdge) return shortest;
  return ((t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[2].x - t[0].x) * (t[1].y - t[0].y)) / longest;
}

/// The time step that a triangle allows.
double step_in(const Depths& depths, const CornerPoints& t, const job::Request::Sizing& asked) {
  const double speed = std::sqrt(9.81 * std::max(1.0, greatest_by_cells(depths, t))) + asked.courant_speed;
  return asked.courant * length_of(t, asked.courant_length) / speed;
}

/// A star-shaped outline of some kilometers, whose edges are longer the fewer points it has.
Pslg random_outline(Random& random, int points) {
  Pslg pslg;
  const double radius = uniform(random, 3e3, 2e4);
  for (int k = 0; k < points; ++k) {
    const double angle = 2 * std::numbers::pi * (k + uniform(random, -0.3, 0.3)) / points;
    const double far = radius * uniform(random, 0.6, 1);
    pslg.points.push_back({far * std::cos(angle), far * std::sin(angle)});
    pslg.segments.push_back({k, (k + 1) % points, 1});
  }
  return pslg;
}

/// A request for a mesh in a domain with these depths, which a file holds.
class Asked {
 public:
  Asked(Random& random, const Pslg& domain, std::int64_t most_cells) {
    Box box = Box::of(domain.points);
    const double margin = uniform(random, -0.1, 0.1) * (box.high.x - box.low.x);
    depths = random_depths(random, Box::around(box.low, box.high, margin), most_cells);
    depths.frame.dy = depths.frame.dx;  // as in the file
    const std::string file = (folder_.path() / "depth.asc").string();
    std::ofstream text(file);
    char head[300];
    std::snprintf(head, sizeof head, "ncols %ld\nnrows %ld\nxllcenter %.17g\nyllcenter %.17g\ncellsize %.17g\n",
                  static_cast<long>(depths.frame.columns), static_cast<long>(depths.frame.rows), depths.frame.first.x,
                  depths.frame.first.y, depths.frame.dx);
    text << head;
    for (std::int64_t j = depths.frame.rows - 1; j >= 0; --j) {
      for (std::int64_t i = 0; i < depths.frame.columns; ++i) {
        char value[40];
        std::snprintf(value, sizeof value, "%.9g ", depths.value(i, j));
        text << value;
      }
      text << "\n";
    }
    request.input.rasters = {{"depth", file}};
    request.output.depth = "depth";
    request.decomposition.subdomains = 1;
    request.limits.max_triangles = 300'000;
    request.bounds.angle = uniform(random, 15, 28);
    job::Request::Sizing& sizing = request.sizing;
    const double size = box.high.x - box.low.x;
    sizing.courant_step = size / 25 / std::exp2(uniform(random, 0, 5)) / 20;
    sizing.courant = uniform(random, 0.3, 1);
    if (random() % 2 == 0) sizing.courant_speed = uniform(random, 0, 3);
    if (random() % 3 == 0) sizing.courant_length = CourantLength::kAltitude;
  }

  /// What the verifier says, with the raster read anew.
  [[nodiscard]] VerifyReport verified(const Mesh& mesh, const Pslg& domain, VerifyOptions& options) const {
    job::Rasters rasters = job::rasters_of(request, "");
    open_all(rasters, job::box_of(domain), {});
    const std::shared_ptr<const Raster> depth = rasters.depths();
    const SizeSource size = job::size_of(request.sizing, rasters.open, nullptr, domain);
    options.min_angle = request.bounds.angle;
    options.plain = request.bounds;
    options.size = size.field.get();
    options.size_is_compiled = true;
    options.courant = job::courant_of(request.sizing);
    options.depth = depth.get();
    VerifyReport report = verify(mesh, domain, options);
    options.size = nullptr;
    options.depth = nullptr;
    return report;
  }

  Depths depths;
  job::Request request;

 private:
  TemporaryFolder folder_;
};

std::vector<CornerPoints> triangles_of(const Mesh& mesh) {
  std::vector<CornerPoints> all;
  for (const auto& [a, b, c] : mesh.triangles) all.push_back({mesh.points[a], mesh.points[b], mesh.points[c]});
  return all;
}

constexpr double kAccuracy = 1e-3;  // relative, of steps by an oracle that looks at 64 points of an edge

}  // namespace

TEST_CASE("the greatest depth in a triangle is what its cells have, whichever corner comes first") {
  Random random = seeded_generator("greatest depths");
  std::int64_t on_edges = 0;  // greater than at corners, crossings and grid points
  for (std::int64_t tried = 0; more_cases(tried, 300, on_edges > 0); ++tried) {
    const Box box{{-3, 2}, {7, 9}};
    const Depths depths = random_depths(random, box, tried % 5 == 0 ? 40 : 6);
    TiledGrid grid(depths.frame);
    for (std::int64_t j = 0; j < depths.frame.rows; ++j)
      for (std::int64_t i = 0; i < depths.frame.columns; ++i) grid.set(i, j, static_cast<float>(depths.value(i, j)));
    const GridRaster raster(std::move(grid));
    const double size = std::exp2(uniform(random, -6, 1));
    const Point middle = somewhere_in(random, box);
    CornerPoints t;
    for (Point& p : t) p = {middle.x + size * 5 * uniform(random, -1, 1), middle.y + size * 5 * uniform(random, -1, 1)};
    const double found = greatest_in(raster, t), expected = greatest_by_cells(depths, t);
    const double scale = *std::ranges::max_element(depths.values) + 2;
    INFO("triangle (", t[0].x, ", ", t[0].y, ") (", t[1].x, ", ", t[1].y, ") (", t[2].x, ", ", t[2].y, ")");
    CHECK(found >= expected - 1e-9 * scale);
    CHECK(found <= expected + 1e-3 * scale);  // the oracle looks at some points of each edge
    CHECK(greatest_in(raster, {t[2], t[0], t[1]}) == found);
    CHECK(greatest_in(raster, {t[1], t[0], t[2]}) == found);
    double most = -std::numeric_limits<double>::infinity();
    for (const Point& p : t) most = std::max(most, depths.at(p));
    if (found > most + 1e-6 * scale && found < scale - 2 - 1e-6 * scale) ++on_edges;
  }
  CHECK(on_edges > 0);
}

TEST_CASE("the summary and the verifier tell the step that holds, and other bounds hold") {
  Random random = seeded_generator("time steps");
  std::int64_t missed = 0, held = 0, decided = 0;
  for (std::int64_t tried = 0; more_cases(tried, 40, missed > 0 && held > 0 && decided > 0); ++tried) {
    const Pslg domain = random_outline(random, tried % 2 == 0 ? 6 : 40);
    Asked asked(random, domain, 30);
    job::Request& request = asked.request;
    const Box box = Box::of(domain.points);
    if (random() % 2 == 0)
      request.bounds.area = std::pow((box.high.x - box.low.x) / std::exp2(uniform(random, 2, 6)), 2);
    if (random() % 2 == 0)
      request.sizing.expression = std::to_string((box.high.x - box.low.x) / 60) + "+0.1*distance()";
    const Made one = made(domain, request);
    const std::vector<CornerPoints> triangles = triangles_of(one.mesh);
    double holds = std::numeric_limits<double>::infinity();
    std::int64_t surely = 0, perhaps = 0;
    for (const CornerPoints& t : triangles) {
      const double step = step_in(asked.depths, t, request.sizing);
      holds = std::min(holds, step);
      if (step < request.sizing.courant_step * (1 - kAccuracy)) ++surely;
      if (step < request.sizing.courant_step * (1 + kAccuracy)) ++perhaps;
    }
    INFO("case ", tried, ": ", one.mesh.triangles.size(), " triangles, ", one.record.step.misses(), " miss");
    const double told = request.sizing.courant_step * one.record.step.least_room;
    CHECK(told == doctest::Approx(holds).epsilon(kAccuracy));
    CHECK(one.record.step.misses() >= surely);
    CHECK(one.record.step.misses() <= perhaps);
    VerifyOptions options;
    const VerifyReport report = asked.verified(one.mesh, domain, options);
    CHECK_MESSAGE(report.accepted(), report_text(report, options));
    CHECK(static_cast<std::int64_t>(report.step.above) >= surely);
    CHECK(static_cast<std::int64_t>(report.step.above) <= perhaps);
    CHECK(request.sizing.courant / report.step.greatest * request.sizing.courant_step ==
          doctest::Approx(holds).epsilon(kAccuracy));
    options.strict_step = true;
    CHECK(asked.verified(one.mesh, domain, options).accepted() == (report.step.above == 0));
    missed += one.record.step.misses() > 0 ? 1 : 0;
    held += one.record.step.misses() == 0 ? 1 : 0;
    decided += one.record.step.least_room < 2 ? 1 : 0;
  }
  CHECK(missed > 0);
  CHECK(held > 0);
  CHECK(decided > 0);
}

TEST_CASE("without bounds on sizes, only deleting vertices changes the mesh, and no more triangles miss the step") {
  Random random = seeded_generator("thinning");
  std::int64_t before = 0, after = 0;
  for (std::int64_t tried = 0; more_cases(tried, 30, before > 0); ++tried) {
    const Pslg domain = random_outline(random, 20 + static_cast<int>(random() % 80));
    Asked asked(random, domain, 12);
    if (tried % 3 == 0) asked.request.decomposition.subdomains = 4;
    if (tried % 3 != 1) asked.request.sizing.courant_length = CourantLength::kAltitude;  // where it does most
    VerifyOptions options;
    const Made thinned = made(domain, asked.request);
    const VerifyReport report = asked.verified(thinned.mesh, domain, options);
    CHECK_MESSAGE(report.accepted(), report_text(report, options));
    const job::Request with_step = asked.request;
    asked.request.sizing = {};
    const Mesh plain = made(domain, asked.request).mesh;
    asked.request = with_step;
    const std::uint64_t of_plain = asked.verified(plain, domain, options).step.above;
    INFO("case ", tried, ": ", plain.triangles.size(), " triangles, thinned ", thinned.mesh.triangles.size());
    CHECK(report.step.above <= of_plain);
    CHECK(thinned.mesh.triangles.size() <= plain.triangles.size());
    before += static_cast<std::int64_t>(of_plain);
    after += static_cast<std::int64_t>(report.step.above);
  }
  std::printf("triangles above the bound: %ld, thinned %ld\n", static_cast<long>(before), static_cast<long>(after));
  CHECK(before > 0);
}
