#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "driftmesh/error.hpp"
#include "geometry/triangle_geometry.hpp"
#include "property/cases.hpp"
#include "raster/ascii_grid.hpp"
#include "raster/nearest_values.hpp"
#include "raster/raster.hpp"
#include "sizing/expression_field.hpp"
#include "sizing/make_size_field.hpp"
#include "sizing/named_raster.hpp"
#include "support/made_mesh.hpp"
#include "support/random.hpp"
#include "temporary_folder.hpp"

// Rasters of random values against what is found in their arrays one by one, and meshes whose sizes they ask for.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

/// A raster with its values as one array, row by row from below.
struct Drawn {
  RasterFrame frame;
  std::vector<float> values;

  [[nodiscard]] float value(std::int64_t i, std::int64_t j) const {
    return values[static_cast<std::size_t>(j * frame.columns + i)];
  }
  [[nodiscard]] TiledGrid grid() const {
    TiledGrid made(frame);
    for (std::int64_t j = 0; j < frame.rows; ++j)
      for (std::int64_t i = 0; i < frame.columns; ++i) made.set(i, j, value(i, j));
    return made;
  }
  /// By the four products of the textbook.
  [[nodiscard]] double at(const Point& p) const {
    const auto steps = [](double x, double first, double spacing, std::int64_t count) {
      return std::min(std::max((x - first) / spacing, 0.0), static_cast<double>(count - 1));
    };
    const double u = steps(p.x, frame.first.x, frame.dx, frame.columns),
                 v = steps(p.y, frame.first.y, frame.dy, frame.rows);
    double sum = 0;
    for (std::int64_t j = 0; j < frame.rows; ++j)
      for (std::int64_t i = 0; i < frame.columns; ++i) {
        const double s = 1 - std::abs(u - static_cast<double>(i)), t = 1 - std::abs(v - static_cast<double>(j));
        if (s > 0 && t > 0) sum += s * t * value(i, j);
      }
    return sum;
  }
};

Drawn random_raster(Random& random, std::int64_t most) {
  const auto count = [&] { return 1 + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(most)); };
  Drawn drawn;
  drawn.frame = {count(),
                 count(),
                 {uniform(random, -1e5, 1e5), uniform(random, -1e5, 1e5)},
                 std::exp(uniform(random, -3, 3)),
                 std::exp(uniform(random, -3, 3))};
  const double scale = std::exp(uniform(random, -5, 8));
  for (std::int64_t k = 0; k < drawn.frame.columns * drawn.frame.rows; ++k)
    drawn.values.push_back(static_cast<float>(uniform(random, -scale, scale)));
  return drawn;
}

/// The ends of an interval, and the points of a grid in it.
std::vector<double> places_in(double low, double high, double first, double spacing, std::int64_t count) {
  std::vector<double> places{low, high};
  for (std::int64_t k = 0; k < count; ++k)
    if (const double x = first + spacing * static_cast<double>(k); low < x && x < high) places.push_back(x);
  return places;
}

/// Somewhere in the raster or near it, now and then exactly at one of its points.
Point random_place(Random& random, const RasterFrame& f) {
  const auto along = [&](double first, double spacing, std::int64_t count) {
    const double steps = uniform(random, -1.5, static_cast<double>(count) + 0.5);
    return first + spacing * (random() % 4 == 0 ? std::round(steps) : steps);
  };
  return {along(f.first.x, f.dx, f.columns), along(f.first.y, f.dy, f.rows)};
}

}  // namespace

TEST_CASE("values are those of the four points around, and bounds hold them") {
  Random random = seeded_generator("raster values");
  for (std::int64_t tried = 0; more_cases(tried, 400, true); ++tried) {
    const Drawn drawn = random_raster(random, tried % 8 == 0 ? 150 : 20);
    const GridRaster raster(drawn.grid());
    const double scale = std::abs(*std::ranges::max_element(drawn.values, {}, [](float v) { return std::abs(v); }));
    const std::shared_ptr<const Raster> slope = raster.slope();
    for (int k = 0; k < 20; ++k) {
      const Point p = random_place(random, drawn.frame);
      const double rounding = 1e-12 * scale * (1 + std::abs(p.x / drawn.frame.dx) + std::abs(p.y / drawn.frame.dy));
      CHECK(std::abs(raster.at(p) - drawn.at(p)) <= rounding);
      const Point q = random_place(random, drawn.frame);
      const double size = std::exp(uniform(random, -8, 0));
      const Box box = Box::around(p, {p.x + size * (q.x - p.x), p.y + size * (q.y - p.y)});
      const Extent values = raster.over(box), slopes = slope->over(box);
      for (int n = 0; n < 20; ++n) {
        const Point inside{uniform(random, box.low.x, box.high.x), uniform(random, box.low.y, box.high.y)};
        const double here = raster.at(inside), steep = slope->at(inside);
        CHECK((values.low <= here && here <= values.high));
        CHECK((slopes.low <= steep && steep <= slopes.high));
      }
      CHECK((values.low <= raster.at(p) && raster.at(p) <= values.high));
      // Exact over few points of the grid: extremes are at the corners of the box, or where lines of the grid meet it.
      if (box.high.x - box.low.x > 3 * drawn.frame.dx || box.high.y - box.low.y > 3 * drawn.frame.dy) continue;
      double low = std::numeric_limits<double>::infinity(), high = -low;
      for (const double x : places_in(box.low.x, box.high.x, drawn.frame.first.x, drawn.frame.dx, drawn.frame.columns))
        for (const double y : places_in(box.low.y, box.high.y, drawn.frame.first.y, drawn.frame.dy, drawn.frame.rows)) {
          low = std::min(low, drawn.at({x, y}));
          high = std::max(high, drawn.at({x, y}));
        }
      CHECK(values.low >= low - rounding);
      CHECK(values.high <= high + rounding);
    }
  }
}

TEST_CASE("what has no value gets that of the nearest point that has one") {
  Random random = seeded_generator("nearest values");
  for (std::int64_t tried = 0; more_cases(tried, 300, true); ++tried) {
    Drawn drawn = random_raster(random, 25);
    const double share = uniform(random, 0, 1);
    std::int64_t missing = 0;
    for (float& v : drawn.values)
      if (uniform(random, 0, 1) < share) v = std::numeric_limits<float>::quiet_NaN(), ++missing;
    TiledGrid grid = drawn.grid();
    const double width = drawn.frame.dx, height = drawn.frame.dy;
    CHECK(fill_from_nearest(grid, width, height) == missing);
    if (missing == drawn.frame.columns * drawn.frame.rows) continue;
    for (std::int64_t j = 0; j < drawn.frame.rows; ++j)
      for (std::int64_t i = 0; i < drawn.frame.columns; ++i) {
        double least = std::numeric_limits<double>::infinity();
        const auto away = [&](std::int64_t k, std::int64_t l) {
          return std::hypot(width * static_cast<double>(k - i), height * static_cast<double>(l - j));
        };
        for (std::int64_t l = 0; l < drawn.frame.rows; ++l)
          for (std::int64_t k = 0; k < drawn.frame.columns; ++k)
            if (!std::isnan(drawn.value(k, l))) least = std::min(least, away(k, l));
        bool found = false;
        for (std::int64_t l = 0; l < drawn.frame.rows; ++l)
          for (std::int64_t k = 0; k < drawn.frame.columns; ++k)
            found = found || (drawn.value(k, l) == grid.at(i, j) && away(k, l) <= least * (1 + 1e-12));
        CHECK(found);
      }
  }
}

namespace {

using Corner = std::array<Point, 3>;

Pslg square(double side) {
  Pslg pslg;
  pslg.points = {{0, 0}, {side, 0}, {side, side}, {0, side}};
  pslg.segments = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 0, 1}};
  return pslg;
}

double cross(const Corner& t) {
  return (t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[1].y - t[0].y) * (t[2].x - t[0].x);
}

/// A basin 100 wide with one narrow trench or shoal of few cells, which no point of a coarse mesh would meet.
Drawn random_basin(Random& random) {
  Drawn drawn;
  drawn.frame = {80, 80, {0.3, -0.2}, 1.25, 1.25};
  const double tilt = uniform(random, 0, 0.3);
  for (std::int64_t j = 0; j < 80; ++j)
    for (std::int64_t i = 0; i < 80; ++i)
      drawn.values.push_back(static_cast<float>(60 + tilt * static_cast<double>(i) + uniform(random, 0, 1)));
  const auto i = static_cast<std::int64_t>(5 + random() % 70), j = static_cast<std::int64_t>(5 + random() % 70);
  const auto length = static_cast<std::int64_t>(1 + random() % 9);
  for (std::int64_t k = 0; k < length && i + k < 80; ++k)
    drawn.values[static_cast<std::size_t>(j * 80 + i + k)] = static_cast<float>(uniform(random, 0.5, 4));
  return drawn;
}

/// As an ESRI ASCII grid with square cells.
void write_grid(const Drawn& drawn, const std::string& file) {
  const RasterFrame& f = drawn.frame;
  std::ofstream out(file);
  out.precision(9);
  out << "ncols " << f.columns << "\nnrows " << f.rows << "\nxllcenter " << f.first.x << "\nyllcenter " << f.first.y
      << "\ncellsize " << f.dx << '\n';
  for (std::int64_t j = f.rows; j-- > 0;)
    for (std::int64_t i = 0; i < f.columns; ++i) out << drawn.value(i, j) << (i + 1 < f.columns ? ' ' : '\n');
}

}  // namespace

TEST_CASE("every triangle obeys what a raster asks for, in one piece and in subdomains, with and without gradation") {
  Random random = seeded_generator("raster meshes");
  for (std::int64_t tried = 0; more_cases(tried, 40, true); ++tried) {
    const Drawn drawn = random_basin(random);
    const TemporaryFolder folder;
    job::Request request;
    request.input.rasters["depth"] = (folder.path() / "depth.asc").string();
    write_grid(drawn, request.input.rasters["depth"]);
    request.sizing.expression = "max(0.4, 1.5*sqrt(max(depth, 0.1)))";
    request.sizing.gradation = tried % 2 == 1 ? 0.3 : 0;
    request.decomposition.subdomains = tried % 4 < 2 ? 1 : 6;
    const Mesh mesh = made(square(100), request).mesh;
    // Each point of the grid, which is where values are extreme, by the array itself.
    double worst = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
      const Corner t{mesh.points[a], mesh.points[b], mesh.points[c]};
      const Box box = Box::of(t);
      const double edge = std::sqrt(cross(t) * 2 / std::sqrt(3.0));
      const auto to = [](double x, double first) { return (x - first) / 1.25; };
      for (auto j = std::max<std::int64_t>(0, static_cast<std::int64_t>(std::ceil(to(box.low.y, -0.2))));
           j < 80 && j <= to(box.high.y, -0.2); ++j)
        for (auto i = std::max<std::int64_t>(0, static_cast<std::int64_t>(std::ceil(to(box.low.x, 0.3))));
             i < 80 && i <= to(box.high.x, 0.3); ++i) {
          const Point p{0.3 + 1.25 * static_cast<double>(i), -0.2 + 1.25 * static_cast<double>(j)};
          if (contains(t, p)) worst = std::max(worst, edge / (1.5 * std::sqrt(static_cast<double>(drawn.value(i, j)))));
        }
      for (const Point& p : t) worst = std::max(worst, edge / (1.5 * std::sqrt(drawn.at(p))));
    }
    CHECK(worst <= 1.25 * (1 + 1e-6));  // 1 / kTolerated
    CHECK(worst > 0.5);
  }
}

namespace {

/// Rules as coastal modelers have them: that change slowly, fast, and from one place to the next.
std::string random_rule(Random& random) {
  const auto number = [&](double low, double high) { return std::to_string(uniform(random, low, high)); };
  const std::string depth = number(0.3, 2) + "*sqrt(max(depth, 0.1))";
  const std::string slope = number(0.5, 3) + "*depth/max(slope(depth), 0.05)";
  const std::string shore = number(0.2, 1) + "+" + number(0.02, 2) + "*distance(1)";
  const std::string rules[] = {depth, shore, slope, "min(" + depth + "," + shore + ")",
                               "min(" + depth + "," + slope + "," + shore + ")"};
  return "max(" + number(0.1, 0.5) + "," + rules[random() % 5] + ")";
}

/// What the limit allows from anywhere in a box, by squares of a grid: the values at their centers from above, and
/// bounds of the expression over them from below.
struct GridLimit {
  static constexpr int kSquares = 160;
  double gradation = 0;
  std::vector<Box> squares;
  std::vector<double> at_centers, bounds;

  GridLimit(const ExpressionField& plain, double limit, double side) : gradation(limit) {
    const double w = side / kSquares;
    for (int j = 0; j < kSquares; ++j)
      for (int i = 0; i < kSquares; ++i) {
        squares.push_back({{i * w, j * w}, {(i + 1) * w, (j + 1) * w}});
        at_centers.push_back(plain.edge_length(squares.back().center()));
        bounds.push_back(plain.function()->over(squares.back()).value.low);
      }
  }
  [[nodiscard]] double above(const Point& p) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < squares.size(); ++k) {
      const Point q = squares[k].center();
      least = std::min(least, at_centers[k] + gradation * std::hypot(p.x - q.x, p.y - q.y));
    }
    return least;
  }
  [[nodiscard]] double below(const Point& p) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < squares.size(); ++k)
      least = std::min(least, bounds[k] + gradation * std::sqrt(squares[k].squared_distance(p)));
    return least;
  }
};

}  // namespace

TEST_CASE("limited growth is the least of a grid, whatever was asked before, and known between corners") {
  Random random = seeded_generator("graded rules");
  int limited = 0, surely = 0;
  for (std::int64_t tried = 0; more_cases(tried, 12, limited > 100 && surely > 100); ++tried) {
    const Drawn drawn = random_basin(random);
    const NamedRasters rasters{{"depth", std::make_shared<const GridRaster>(drawn.grid())}};
    Pslg pslg = square(100);
    for (Pslg::Segment& s : pslg.segments) s.marker = static_cast<std::int32_t>(1 + random() % 3);
    pslg.segments.front().marker = 1;
    const std::string rule = random_rule(random);
    const double gradation = std::exp(uniform(random, -3, 0));
    CAPTURE(rule);
    CAPTURE(gradation);
    const ExpressionField plain(rule, 0, std::numeric_limits<double>::infinity(), &pslg, rasters);
    SizingOptions asked{.expression = rule, .gradation = gradation, .spacing = 0.05, .domain = {{0, 0}, {100, 100}}};
    asked.input = &pslg;
    asked.rasters = rasters;
    const auto field = make_size_field(asked), backward = make_size_field(asked);
    asked.exact = true;
    const auto exact = make_size_field(asked);
    const GridLimit limit(plain, gradation, 100);
    std::vector<Point> points;
    std::vector<double> lengths;
    for (int k = 0; k < 60; ++k) {
      points.push_back({uniform(random, 0, 100), uniform(random, 0, 100)});
      if (k % 3 != 0) points.back() = {points[k - 1].x, std::min(100.0, points[k - 1].y + uniform(random, 0, 1))};
      const Point& p = points.back();
      lengths.push_back(field->edge_length(p));
      CAPTURE(p.x);
      CAPTURE(p.y);
      const double ungraded = plain.edge_length(p), most = std::min(limit.above(p), ungraded);
      CHECK(exact->edge_length(p) <= most / 0.97 * (1 + 1e-9));
      CHECK(exact->edge_length(p) >= limit.below(p) * 0.9);
      CHECK(lengths.back() <= most * 1.16);
      CHECK(lengths.back() >= limit.below(p) * 0.75);
      limited += lengths.back() < 0.8 * ungraded ? 1 : 0;
    }
    for (std::size_t k = points.size(); k-- > 0;) CHECK(backward->edge_length(points[k]) == lengths[k]);
    for (std::size_t k = 0; k + 2 < points.size(); k += 3) {
      const Corner t{
          points[k], points[k + 1], {std::clamp(points[k].x + uniform(random, -1, 1), 0.0, 100.0), points[k].y}};
      const double at_corners = std::min({lengths[k], lengths[k + 1], field->edge_length(t[2])});
      if (field->least_between(t, at_corners) < at_corners) continue;
      ++surely;
      for (int m = 0; m < 10; ++m) {
        double u = uniform(random, 0, 1), v = uniform(random, 0, 1);
        if (u + v > 1) u = 1 - u, v = 1 - v;
        const Point p{t[0].x + u * (t[1].x - t[0].x) + v * (t[2].x - t[0].x),
                      t[0].y + u * (t[1].y - t[0].y) + v * (t[2].y - t[0].y)};
        CHECK(exact->edge_length(p) >= 0.8 * 0.97 * at_corners * (1 - 1e-6));
      }
    }
  }
  CHECK(surely > 100);
}

TEST_CASE("a text grid that is edited at random is refused with its line, or has the values that it announces") {
  Random random = seeded_generator("edited grids");
  std::int64_t refused = 0, accepted = 0;
  for (std::int64_t tried = 0; more_cases(tried, 4000, refused > 0 && accepted > 0); ++tried) {
    std::string text = "ncols 4\nnrows 3\nxllcorner -2.5\nyllcenter 1e1\ncellsize 0.5\nNODATA_value -9999\n";
    for (int k = 0; k < 12; ++k) text += std::to_string(uniform(random, -9, 9)) + (k % 4 == 3 ? "\n" : " ");
    for (std::uint64_t edits = 1 + random() % 3; edits > 0; --edits) {
      const std::size_t place = random() % text.size();
      const char byte = "0123456789.-+eE \n\tnxyNaif\0\xff"[random() % 27];
      if (const auto kind = random() % 3; kind == 0)
        text[place] = byte;
      else if (kind == 1)
        text.insert(place, 1, byte);
      else
        text.erase(place, 1 + random() % 8);
    }
    try {
      AsciiGrid grid("depth.asc", text);
      REQUIRE(grid.frame().columns * grid.frame().rows <= static_cast<std::int64_t>(text.size()));
      CHECK((grid.frame().dx > 0 && grid.frame().dy > 0));
      std::vector<float> row(static_cast<std::size_t>(grid.frame().columns));
      for (std::int64_t j = grid.frame().rows - 1; j >= 0; --j) {
        grid.read(j, 0, row);
        for (const float value : row) CHECK_FALSE(std::isinf(value));
      }
      grid.finish();
      ++accepted;
    } catch (const InputError& error) {
      ++refused;
      CHECK(std::string(error.what()).starts_with("depth.asc:"));
      CHECK(error.place().line > 0);
    }
  }
}
