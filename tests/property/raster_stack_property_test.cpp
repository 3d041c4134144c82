#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "gis/transverse_mercator.hpp"
#include "property/cases.hpp"
#include "raster/open_raster.hpp"
#include "support/random.hpp"
#include "temporary_folder.hpp"

// Stacks of random rasters in files against what is found in their values one by one, and bounds against samples.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

/// A raster in a file, with its values row by row from below.
struct Tile {
  RasterFrame frame;
  std::vector<double> values;  // NaN: none
  std::string path;

  [[nodiscard]] double value(std::int64_t i, std::int64_t j) const {
    if (i < 0 || j < 0 || i >= frame.columns || j >= frame.rows) return std::numeric_limits<double>::quiet_NaN();
    return values[static_cast<std::size_t>(j * frame.columns + i)];
  }
  [[nodiscard]] Point point(std::int64_t i, std::int64_t j) const {
    return {frame.first.x + static_cast<double>(i) * frame.dx, frame.first.y + static_cast<double>(j) * frame.dy};
  }
  void write() const {
    std::ostringstream text;
    text.precision(17);
    text << "ncols " << frame.columns << "\nnrows " << frame.rows << "\nxllcenter " << frame.first.x << "\nyllcenter "
         << frame.first.y << "\ncellsize " << frame.dx << "\n";
    for (std::int64_t j = frame.rows - 1; j >= 0; --j)
      for (std::int64_t i = 0; i < frame.columns; ++i)
        text << (std::isnan(value(i, j)) ? -9999 : value(i, j)) << (i + 1 == frame.columns ? '\n' : ' ');
    std::ofstream(path) << text.str();
  }
  /// The distance from a place to what has no value: a point without one, inside of it or around it.
  [[nodiscard]] double to_gap(const Point& p) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::int64_t j = -1; j <= frame.rows; ++j)
      for (std::int64_t i = -1; i <= frame.columns; ++i)
        if (std::isnan(value(i, j))) least = std::min(least, std::hypot(point(i, j).x - p.x, point(i, j).y - p.y));
    return least;
  }
  [[nodiscard]] bool surrounds(const Point& p) const {
    return p.x > frame.first.x - frame.dx && p.x < point(frame.columns, 0).x && p.y > frame.first.y - frame.dy &&
           p.y < point(0, frame.rows).y;
  }
  /// Bilinear among points that all have values.
  [[nodiscard]] double at(const Point& p) const {
    const double u = (p.x - frame.first.x) / frame.dx, v = (p.y - frame.first.y) / frame.dy;
    const auto i = static_cast<std::int64_t>(std::floor(u)), j = static_cast<std::int64_t>(std::floor(v));
    const double s = u - static_cast<double>(i), t = v - static_cast<double>(j);
    return (1 - t) * ((1 - s) * value(i, j) + s * value(i + 1, j)) +
           t * ((1 - s) * value(i, j + 1) + s * value(i + 1, j + 1));
  }
};

Tile random_tile(Random& random, const std::filesystem::path& folder, int number, double missing) {
  Tile tile;
  const double spacing = std::exp(uniform(random, -1.5, 0.7));
  tile.frame = {3 + static_cast<std::int64_t>(random() % 30),
                3 + static_cast<std::int64_t>(random() % 30),
                {uniform(random, 995, 1020), uniform(random, 995, 1020)},
                spacing,
                spacing};
  for (std::int64_t k = 0; k < tile.frame.columns * tile.frame.rows; ++k)
    tile.values.push_back(uniform(random, 0, 1) < missing ? std::numeric_limits<double>::quiet_NaN()
                                                          : static_cast<float>(uniform(random, -50, 50)));
  tile.path = (folder / ("tile" + std::to_string(number) + ".asc")).string();
  tile.write();
  return tile;
}

/// One that covers the whole domain.
Tile wide_tile(Random& random, const std::filesystem::path& folder) {
  Tile tile;
  tile.frame = {30, 30, {980, 980}, 2.3, 2.3};
  for (int k = 0; k < 900; ++k) tile.values.push_back(static_cast<float>(uniform(random, -50, 50)));
  tile.path = (folder / "wide.asc").string();
  tile.write();
  return tile;
}

constexpr Box kDomain{{1000, 1000}, {1020, 1020}};

Point place_in(Random& random, const Box& box) {
  return {uniform(random, box.low.x, box.high.x), uniform(random, box.low.y, box.high.y)};
}

std::vector<std::string> paths_of(const std::vector<Tile>& tiles) {
  std::vector<std::string> paths;
  for (const Tile& tile : tiles) paths.push_back(tile.path);
  return paths;
}

}  // namespace

TEST_CASE("a stack has the value of the first raster far from its gaps, and that of the next in them") {
  Random random = seeded_generator("stacks");
  int upper = 0, lower = 0;
  for (std::int64_t tried = 0; more_cases(tried, 60, upper > 100 && lower > 100); ++tried) {
    CAPTURE(tried);
    const TemporaryFolder folder;
    const double blend = tried % 3 == 0 ? 0 : uniform(random, 0, 5), missing = tried % 2 == 0 ? 0 : 0.02;
    std::vector<Tile> tiles;
    for (int k = 0; k < 1 + static_cast<int>(random() % 4); ++k)
      tiles.push_back(random_tile(random, folder.path(), k, missing));
    tiles.push_back(wide_tile(random, folder.path()));
    const bool finest = random() % 2 == 0;
    const OpenedRaster opened = open_rasters(paths_of(tiles), {kDomain, {}, {}}, {blend, finest});
    if (finest) std::ranges::stable_sort(tiles, {}, [](const Tile& t) { return t.frame.dx; });
    for (int n = 0; n < 200; ++n) {
      const Point p = place_in(random, kDomain);
      double expected = std::numeric_limits<double>::quiet_NaN();
      for (const Tile& tile : tiles) {
        if (!tile.surrounds(p)) continue;
        // Within a square the share is that of its corners, a diagonal away.
        const double gap = tile.to_gap(p) - 1.5 * tile.frame.dx;
        if (gap > std::max(blend, tile.frame.dx)) expected = tile.at(p);
        if (tile.to_gap(p) > 1e-9) break;
      }
      if (std::isnan(expected)) continue;
      ++(tiles.front().surrounds(p) ? upper : lower);
      CHECK(opened.raster->at(p) == doctest::Approx(expected).epsilon(1e-6));
    }
  }
}

TEST_CASE("a stack is continuous, and its bounds hold values and slopes") {
  Random random = seeded_generator("bounds of stacks");
  int blended = 0;
  for (std::int64_t tried = 0; more_cases(tried, 40, blended > 100); ++tried) {
    CAPTURE(tried);
    const TemporaryFolder folder;
    std::vector<Tile> tiles;
    for (int k = 0; k < 2 + static_cast<int>(random() % 4); ++k)
      tiles.push_back(random_tile(random, folder.path(), k, 0.05));
    tiles.push_back(wide_tile(random, folder.path()));
    const OpenedRaster opened =
        open_rasters(paths_of(tiles), {kDomain, {}, {}}, {uniform(random, 0, 4), random() % 2 == 0});
    for (const auto& raster : {opened.raster, opened.raster->slope()})
      for (int n = 0; n < 60; ++n) {
        const Point p = place_in(random, {{990, 990}, {1030, 1030}}), q = place_in(random, kDomain);
        const double size = std::exp(uniform(random, -9, 0));
        const Box box = Box::around(p, {p.x + size * (q.x - p.x), p.y + size * (q.y - p.y)});
        const Extent values = raster->over(box);
        const Raster::Slopes slopes = raster->slopes_over(box);
        for (int k = 0; k < 20; ++k) {
          const Point a = place_in(random, box);
          const Point east{uniform(random, box.low.x, box.high.x), a.y},
              north{a.x, uniform(random, box.low.y, box.high.y)};
          const double here = raster->at(a);
          CHECK((values.low <= here && here <= values.high));
          const auto holds = [&](const Extent& bounds, double rise, double run) {
            const double rounding = 1e-9 * (1 + std::abs(here));
            return std::min(bounds.low * run, bounds.high * run) - rounding <= rise &&
                   rise <= std::max(bounds.low * run, bounds.high * run) + rounding;
          };
          if (!std::isfinite(slopes.in_x.low)) continue;
          ++blended;
          CHECK(holds(slopes.in_x, raster->at(east) - here, east.x - a.x));
          CHECK(holds(slopes.in_y, raster->at(north) - here, north.y - a.y));
        }
      }
  }
}

TEST_CASE("tiles of one grid are one raster: seams between them are not there") {
  Random random = seeded_generator("tiles");
  for (std::int64_t tried = 0; more_cases(tried, 20, true); ++tried) {
    const TemporaryFolder folder;
    Tile whole = random_tile(random, folder.path(), 100, tried % 2 == 0 ? 0 : 0.03);
    whole.frame = {40, 36, {990.25, 991.5}, 1.0 + 0.25 * static_cast<double>(random() % 3), 0};
    whole.frame.dy = whole.frame.dx;
    whole.values.clear();
    for (int k = 0; k < 40 * 36; ++k) whole.values.push_back(static_cast<float>(uniform(random, -50, 50)));
    whole.write();
    std::vector<Tile> tiles;
    const std::int64_t across = 1 + static_cast<std::int64_t>(random() % 4), rows = 9;
    for (std::int64_t j = 0; j < whole.frame.rows; j += rows)
      for (std::int64_t i = 0; i < 40; i += 40 / across) {
        Tile& tile = tiles.emplace_back();
        tile.frame = whole.frame;
        tile.frame.first = whole.point(i, j);
        tile.frame.columns = std::min(40 / across, 40 - i);
        tile.frame.rows = rows;
        for (std::int64_t l = 0; l < rows; ++l)
          for (std::int64_t k = 0; k < tile.frame.columns; ++k) tile.values.push_back(whole.value(i + k, j + l));
        tile.path = (folder.path() / ("part" + std::to_string(tiles.size()) + ".asc")).string();
        tile.write();
      }
    std::ranges::shuffle(tiles, random);
    const RasterPlace place{kDomain, {}, {}};
    const OpenedRaster parts = open_rasters(paths_of(tiles), place, {uniform(random, 0, 3), false});
    const OpenedRaster one = open_raster(whole.path, place);
    for (int n = 0; n < 200; ++n) {
      const Point p = place_in(random, kDomain);
      CHECK(parts.raster->at(p) == doctest::Approx(one.raster->at(p)).epsilon(1e-9));
    }
  }
}

TEST_CASE("tiles in degrees serve a domain in meters") {
  Random random = seeded_generator("tiles in degrees");
  const TemporaryFolder folder;
  const UtmZone zone = utm_zone_of(3, 50);
  const auto depth = [](const Point& place) { return 10 + 5 * std::sin(place.x * 30) * std::cos(place.y * 20); };
  const auto tile_of = [&](int number, const Point& first, double spacing, std::int64_t count, double more) {
    Tile tile;
    tile.frame = {count, count, first, spacing, spacing};
    for (std::int64_t j = 0; j < count; ++j)
      for (std::int64_t i = 0; i < count; ++i) tile.values.push_back(depth(tile.point(i, j)) + more);
    tile.path = (folder.path() / ("degrees" + std::to_string(number) + ".asc")).string();
    tile.write();
    return tile;
  };
  // The finer one, in the middle of the other, is deeper by 100.
  const std::vector<Tile> tiles{tile_of(1, {2, 49.5}, 0.01, 201, 0), tile_of(2, {2.9, 49.9}, 0.001, 201, 100)};
  const Box domain = Box::of(std::vector{utm(2.5, 49.7, zone), utm(3.5, 50.3, zone)});
  const OpenedRaster opened = open_rasters(paths_of(tiles), {domain, {}, Projection(zone)}, {2000, true});
  int inside = 0, outside = 0;
  for (int n = 0; n < 1000; ++n) {
    const Point p = place_in(random, domain), place = geographic(p, zone);
    const double east = std::abs(place.x - 3), north = std::abs(place.y - 50), value = opened.raster->at(p);
    CAPTURE(place.x);
    CAPTURE(place.y);
    if (east < 0.065 && north < 0.075) {  // 2.5 km from the sides, a degree being 71.7 by 111 km
      ++inside;
      CHECK(value == doctest::Approx(depth(place) + 100).epsilon(0.001));
    } else if (east > 0.105 || north > 0.105) {
      ++outside;
      CHECK(value == doctest::Approx(depth(place)).epsilon(0.05));
    } else {
      CHECK((value > 4 && value < 116));
    }
  }
  CHECK((inside > 5 && outside > 500));
}
