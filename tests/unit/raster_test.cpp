#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/formatted.hpp"
#include "driftmesh/error.hpp"
#include "gis/transverse_mercator.hpp"
#include "raster/ascii_grid.hpp"
#include "raster/nearest_values.hpp"
#include "raster/open_raster.hpp"
#include "raster/raster_stack.hpp"
#include "raster/read_tiles.hpp"
#include "raster/resample.hpp"
#include "support/error_text.hpp"
#include "temporary_folder.hpp"

// Grids in text, their values as functions of position, and their places on the globe.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// The rows as they are read, the topmost first.
std::vector<std::vector<float>> rows_of(const std::string& text) {
  AsciiGrid grid("depth.asc", text);
  std::vector<std::vector<float>> rows;
  for (std::int64_t j = grid.frame().rows - 1; j >= 0; --j) {
    rows.emplace_back(static_cast<std::size_t>(grid.frame().columns));
    grid.read(j, 0, rows.back());
  }
  grid.finish();
  return rows;
}

std::string error_of_rows(const std::string& text) {
  return error_text<InputError>([&] { static_cast<void>(rows_of(text)); });
}

const std::string kHeader = "ncols 3\nnrows 2\nxllcorner 10\nyllcorner 20\ncellsize 4\n";

std::string written(const TemporaryFolder& folder, const std::string& text) {
  const std::string path = (folder.path() / "depth.asc").string();
  std::ofstream(path) << text;
  return path;
}

}  // namespace

TEST_CASE("an ESRI ASCII grid has its values in the middle of its cells, the topmost row first") {
  const AsciiGrid grid("depth.asc", kHeader + "1 2 3\n4 5 6\n");
  CHECK(grid.frame().columns == 3);
  CHECK(grid.frame().rows == 2);
  CHECK(grid.frame().first == Point{12, 22});
  CHECK(grid.frame().dx == 4);
  CHECK(rows_of(kHeader + "1 2 3\n4 5 6\n") == std::vector<std::vector<float>>{{1, 2, 3}, {4, 5, 6}});
}

TEST_CASE("entries of the header come in any order and case, and values may break lines anywhere") {
  const std::string text =
      "NROWS 2\r\nNCols 3\r\nYLLCENTER 5\r\nXLLCENTER -1e1\r\nDX 2\r\nDY 0.5\r\nnodata_value -1\r\n1 +2\r\n3 -1\r\n5 "
      "nan";
  const AsciiGrid grid("depth.asc", text);
  CHECK(grid.frame().first == Point{-10, 5});
  CHECK(grid.frame().dx == 2);
  CHECK(grid.frame().dy == 0.5);
  const auto rows = rows_of(text);
  CHECK(rows[0] == std::vector<float>{1, 2, 3});
  CHECK(std::isnan(rows[1][0]));
  CHECK(rows[1][1] == 5);
  CHECK(std::isnan(rows[1][2]));
}

TEST_CASE("a damaged grid is refused with the line of the damage") {
  const auto says = [](const std::string& text, const std::string& part) {
    INFO(text);
    CHECK_MESSAGE(error_of_rows(text).find(part) != std::string::npos, error_of_rows(text));
  };
  says(kHeader + "1 2 3\n4 x 6\n", "depth.asc:7: 'x' is not a value");
  says(kHeader + "1 2 3\n4 1,5 6\n", "depth.asc:7: '1,5' is not a value");
  says(kHeader + "1 2 3\n4 5 6 \n\n7\n", "depth.asc:9: '7' follows the last");
  says(kHeader + "1 22222 3\n4 5", "depth.asc:7: the file ends where a value is expected");
  says(kHeader + "1 2\n", "depth.asc:6: the file is too short");
  says(kHeader + "1 2 3\n4 1e99 6\n", "depth.asc:7: '1e99' is beyond single precision");
  says("ncols 3\nncols 3\n", "depth.asc:2: the header has 'ncols' twice");
  says("ncols 3\nrows 3\n", "depth.asc:2: 'rows' is not an entry");
  says("ncols many\n", "depth.asc:1: 'many' is not a number");
  says("ncols 2.5\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3 4 5", "no whole number of columns");
  says("ncols 999999999\nnrows 999999999\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3", "too short");
  says("ncols 1\nnrows 2\nxllcorner 0\nxllcenter 0\nyllcorner 0\ncellsize 1\n1 2", "or twice");
  says("ncols 1\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize -1\n1 2", "not positive");
  says("ncols 1\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize inf\n1 2", "not positive");
  says("ncols 1\nnrows 2\nxllcorner 0\nyllcorner 0\n1 2", "one size of cells");
  says("", "no whole number of columns");
}

TEST_CASE("values are bilinear between the points of a grid, and those of the nearest point outside") {
  const TemporaryFolder folder;
  const OpenedRaster opened = open_raster(written(folder, kHeader + "1 2 3\n4 5 60\n"), {{{10, 20}, {22, 28}}, {}, {}});
  const Raster& raster = *opened.raster;
  CHECK(raster.at({12, 22}) == 4);
  CHECK(raster.at({16, 22}) == 5);
  CHECK(raster.at({20, 26}) == 3);
  CHECK(raster.at({14, 22}) == 4.5);
  CHECK(raster.at({14, 24}) == 3);
  CHECK(raster.at({18, 24}) == doctest::Approx((2 + 3 + 5 + 60) / 4.0));
  CHECK(raster.at({-1000, -1000}) == 4);
  CHECK(raster.at({1e300, 22}) == 60);
  const double far = std::numeric_limits<double>::infinity();
  CHECK(raster.over({{-far, -far}, {far, far}}).low == 1);
  CHECK(raster.over({{-far, -far}, {far, far}}).high == 60);
  CHECK(raster.over({{12, 26}, {15.9, 30}}).high == doctest::Approx(1.975));
}

TEST_CASE("points on the sides of a raster have its values, alone and in a stack") {
  const TemporaryFolder folder;
  const auto grid = [&](const std::string& name, double west, double south, const std::string& values) {
    std::string path = (folder.path() / name).string();
    std::ofstream(path) << formatted("ncols 3\nnrows 2\nxllcorner {}\nyllcorner {}\ncellsize 0.1\n{}\n", west, south,
                                     values);
    return path;
  };
  const std::string full = grid("full.asc", 0.7, 20.2, "1 2 3 4 5 6"),
                    gap = grid("gap.asc", 0.7, 20.2, "1 2 3 4 5 -9999"),
                    coarse = grid("coarse.asc", 0.95, 20.35, "1 2 3 4 5 6");
  std::vector<Point> sides;
  for (const double x : {0.7, 0.8, 0.9, 1.0})
    for (const double y : {20.2, 20.3, 20.4}) sides.push_back({x, y});
  RasterPlace place{.domain = Box::of(sides), .points = sides, .projection = {}};
  CHECK(open_raster(full, place).without == 0);
  CHECK(open_rasters({full, coarse}, place, {}).without == 0);
  // One cell is missing, and the four corners of it are nearest to it or to others.
  CHECK(open_rasters({gap, gap}, place, {}).without == open_raster(gap, place).without);
}

TEST_CASE("the slope of a plane is the same everywhere") {
  RasterFrame frame{7, 5, {100, -50}, 2, 3};
  TiledGrid grid(frame);
  for (std::int64_t j = 0; j < 5; ++j)
    for (std::int64_t i = 0; i < 7; ++i)
      grid.set(i, j, static_cast<float>(0.5 * grid.point(i, j).x - 0.25 * grid.point(i, j).y));
  const GridRaster raster(std::move(grid));
  const double slope = std::hypot(0.5, 0.25);
  CHECK(raster.slope()->at({100, -50}) == doctest::Approx(slope).epsilon(1e-6));
  CHECK(raster.slope()->at({107.1, -43.2}) == doctest::Approx(slope).epsilon(1e-6));
  CHECK(raster.slope() == raster.slope());
}

TEST_CASE("points outside of a raster and without a value are counted, and get the nearest") {
  const TemporaryFolder folder;
  const std::string path = written(folder, kHeader + "1 -9999 3\n4 5 -9999\n");
  const std::vector<Point> points{{16, 26}, {20, 22}, {12, 26}, {9, 26}, {22.1, 21}};
  const OpenedRaster opened = open_raster(path, {Box::of(points), points, {}});
  CHECK(opened.without == 2);
  CHECK(opened.outside == 2);
  CHECK(opened.raster->at({16, 26}) == 1);  // three are as near: the one in the lowest column counts
  CHECK(opened.raster->at({20, 22}) == 5);
  const auto refuses = [&](const std::string& text, const Box& domain, const char* part) {
    CHECK_THROWS_WITH_AS(static_cast<void>(open_raster(written(folder, text), {domain, {}, {}})),
                         doctest::Contains(part), InputError);
  };
  refuses(kHeader + "1 2 3 4 5 6", {{50, 50}, {60, 60}}, "lies elsewhere than the domain");
  refuses(kHeader + "-9999 -9999 -9999 -9999 -9999 -9999", {{10, 20}, {20, 22}}, "has no value in or near");
}

TEST_CASE("the inverse of the projection leads back") {
  for (const double latitude : {-79.0, -33.3, 0.0, 1e-9, 37.5, 60.0, 83.9})
    for (const double away : {-40.0, -3.0, -1e-7, 0.0, 2.9, 39.0}) {
      const UtmZone zone{18, latitude >= 0};
      const Point there = utm(zone.central_meridian() + away, latitude, zone);
      const Point back = geographic(there, zone);
      CHECK(std::abs(back.x - zone.central_meridian() - away) < 2e-12);
      CHECK(std::abs(back.y - latitude) < 2e-12);
    }
  CHECK(utm_zone_named("UTM zone 18N")->epsg() == 32618);
  CHECK(utm_zone_named(UtmZone{60, false}.name())->epsg() == 32760);
  CHECK_FALSE(utm_zone_named("UTM zone 61N"));
  CHECK_FALSE(utm_zone_named(""));
  CHECK(utm_zone_of_epsg(32701)->name() == "UTM zone 1S");
  CHECK_FALSE(utm_zone_of_epsg(32661));
  CHECK_FALSE(utm_zone_of_epsg(4326));
}

TEST_CASE("a raster with an absurd spacing is refused, not resampled") {
  const TemporaryFolder folder;
  const UtmZone zone{18, true};
  const std::vector<Point> points{utm(-76.5, 37, zone), utm(-75.5, 37, zone), utm(-75.5, 38, zone)};
  for (const char* spacing : {"1e-9", "1e-12", "1e-300"}) {
    const std::string file =
        written(folder, "ncols 1\nnrows 1\nxllcenter -76\nyllcenter 37.5\ncellsize " + std::string(spacing) + "\n7\n");
    CHECK_THROWS_WITH_AS(open_raster(file, {Box::of(points), points, Projection(zone)}),
                         doctest::Contains(file.c_str()), Error);
  }
}

TEST_CASE("a raster in degrees is resampled to the domain's zone") {
  // Linear in longitude and latitude, so that only positions can be wrong; seven thousandths of a degree are 780 m.
  const TemporaryFolder folder;
  constexpr double kStep = 0.007, kWest = -77, kSouth = 36.5;
  for (const double turn : {0.0, 360.0}) {  // some count longitudes from Greenwich to the east
    std::string text = "ncols 300\nnrows 300\nxllcenter " + std::to_string(kWest + turn) + "\nyllcenter " +
                       std::to_string(kSouth) + "\ncellsize " + std::to_string(kStep) + "\n";
    for (int row = 299; row >= 0; --row)
      for (int column = 0; column < 300; ++column) text += std::to_string(3 * kStep * column + 5 * kStep * row) + " ";
    const UtmZone zone{18, true};
    const std::vector<Point> points{utm(-76.5, 37, zone), utm(-75.5, 37, zone), utm(-75.5, 38, zone),
                                    utm(-76.5, 38, zone)};
    const OpenedRaster opened = open_raster(written(folder, text), {Box::of(points), points, Projection(zone)});
    CHECK(opened.outside == 0);
    CHECK(opened.without == 0);
    CHECK(dynamic_cast<const GridRaster&>(*opened.raster).frame().dx == 512);
    double worst = 0;
    for (double longitude = -76.4; longitude < -75.6; longitude += 0.0173)
      for (double latitude = 37.1; latitude < 37.9; latitude += 0.0191) {
        const double expected = 3 * (longitude - kWest) + 5 * (latitude - kSouth);
        worst = std::max(worst, std::abs(opened.raster->at(utm(longitude, latitude, zone)) - expected));
      }
    CHECK(worst < 0.01 * 5 * kStep);  // a hundredth of the raster's spacing
  }
}

namespace {

std::shared_ptr<const Raster> plain(double value) {
  TiledGrid grid(RasterFrame{2, 2, {0, 0}, 1, 1});
  for (std::int64_t j = 0; j < 2; ++j)
    for (std::int64_t i = 0; i < 2; ++i) grid.set(i, j, static_cast<float>(value));
  return std::make_shared<const GridRaster>(std::move(grid));
}

}  // namespace

TEST_CASE("a layer of a stack counts by its share of what those above leave") {
  const Box all{{-9, -9}, {9, 9}};
  const RasterStack stack({{plain(8), plain(0.5), all}, {plain(4), plain(0.25), all}, {plain(2), nullptr, {}}});
  CHECK(stack.at({1, 1}) == 5.25);
  CHECK(stack.over({{0.5, 0.5}, {3, 3}}).low == doctest::Approx(5.25));
  CHECK(stack.over({{0.5, 0.5}, {3, 3}}).high == doctest::Approx(5.25));
}

TEST_CASE("where several tiles have a value, that of the first counts") {
  const TemporaryFolder folder;
  const auto tile = [&](const char* name, double left, const char* values) {
    const std::string path = folder.path() / name;
    std::ofstream(path) << "ncols 3\nnrows 1\nxllcenter " << left << "\nyllcenter 0\ncellsize 1\nnodata_value -1\n"
                        << values;
    return RasterTile{path, {3, 1, {left, 0}, 1, 1}};
  };
  const std::vector<RasterTile> tiles{tile("a.asc", 0, "1 2 -1\n"), tile("b.asc", 1, "20 30 40\n")};
  const RasterFrame around{4, 1, {0, 0}, 1, 1};
  for (const std::size_t threads : {1, 2}) {
    const TiledGrid grid = read_tiles(tiles, around, {0, 0, around}, threads);
    std::vector<float> values;
    for (std::int64_t i = 0; i < 4; ++i) values.push_back(grid.at(i, 0));
    CHECK(values == std::vector<float>{1, 2, 30, 40});
  }
}

TEST_CASE("a tile is read before those that overlap it and come later, however long that takes") {
  const TemporaryFolder folder;
  const std::int64_t rows = 4000;
  const auto tile = [&](const char* name, std::int64_t tall, int value) {
    const std::string path = folder.path() / name;
    std::ofstream file(path);
    file << "ncols 4\nnrows " << tall << "\nxllcenter 0\nyllcenter 0\ncellsize 1\n";
    for (std::int64_t j = 0; j < tall; ++j) file << value << ' ' << value << ' ' << value << ' ' << value << '\n';
    return RasterTile{path, {4, tall, {0, 0}, 1, 1}};
  };
  const std::vector<RasterTile> tiles{tile("tall.asc", rows, 1), tile("low.asc", 1, 2)};  // whose row is the last one
  const RasterFrame around{4, rows, {0, 0}, 1, 1};
  CHECK(read_tiles(tiles, around, {0, 0, around}, 2).at(2, 0) == 1);
}

TEST_CASE("beyond the domain, a raster of a stack goes on") {
  const TemporaryFolder folder;
  const auto raster = [&](const char* name, double first, int value, bool gap) {
    const std::string path = folder.path() / name;
    std::ofstream file(path);
    file << "ncols 41\nnrows 41\nxllcenter " << first << "\nyllcenter " << first << "\ncellsize 1\nnodata_value -1\n";
    for (int j = 0; j < 41; ++j)
      for (int i = 0; i < 41; ++i) file << (gap && i == 20 && j == 20 ? -1 : value) << (i < 40 ? ' ' : '\n');
    return path;
  };
  const std::vector<std::string> paths{raster("upper.asc", 0, 7, true), raster("lower.asc", -0.3, 3, false)};
  const OpenedRaster opened = open_rasters(paths, {{{15, 15}, {25, 25}}, {}, {}}, {});
  CHECK(opened.raster->at({20, 20}) == 3);
  for (const Point& p : {Point{20, -9}, Point{20, 49}, Point{-9, 20}, Point{49, 20}}) CHECK(opened.raster->at(p) == 7);
}

TEST_CASE("tiles of one grid that are far apart do not make one huge raster") {
  const TemporaryFolder folder;
  const auto tile = [&](const char* name, double at, int value) {
    const std::string path = folder.path() / name;
    std::ofstream(path) << "ncols 2\nnrows 2\nxllcenter " << at << "\nyllcenter " << at << "\ncellsize 1\n"
                        << value << ' ' << value << '\n'
                        << value << ' ' << value << '\n';
    return path;
  };
  const std::vector<std::string> paths{tile("here.asc", 0, 7), tile("there.asc", 200000, 3)};
  const OpenedRaster opened = open_rasters(paths, {{{0, 0}, {200001, 200001}}, {}, {}}, {});
  CHECK(opened.raster->at({0.5, 0.5}) == 7);
  CHECK(opened.raster->at({200000.5, 200000.5}) == 3);
}

TEST_CASE("bounds hold the values beyond a line of the grid that a box reaches by rounding alone") {
  TiledGrid grid(RasterFrame{40, 3, {0, 0}, 1, 1});
  for (std::int64_t j = 0; j < 3; ++j)
    for (std::int64_t i = 0; i < 40; ++i) grid.set(i, j, i == 15 ? 1000 : i == 16 ? 100 : 0);
  const GridRaster raster(std::move(grid));
  const Point just_beyond{16 - 1e-13, 1};
  REQUIRE(raster.at(just_beyond) > 100);
  const Extent bounds = raster.over({{just_beyond.x, 0}, {30, 2}});
  CHECK(bounds.high >= raster.at(just_beyond));
  CHECK(bounds.high < 100.001);
}

TEST_CASE("a grid in other coordinates covers its box, as finely as the raster in either direction") {
  TiledGrid source(RasterFrame{40, 40, {0, 0}, 1, 1});
  for (std::int64_t j = 0; j < 40; ++j)
    for (std::int64_t i = 0; i < 40; ++i) source.set(i, j, static_cast<float>(i + j));
  const GridRaster raster(std::move(source));
  const Box box{{1.3, 1.3}, {8.7, 8.7}};
  for (const std::pair<double, double>& by : {std::pair(1.0, 1.0), std::pair(4.0, 1.0), std::pair(1.0, 4.0)}) {
    const TiledGrid grid = resample(
        raster,
        [&](const Point& p) {
          return Point{by.first * p.x, by.second * p.y};
        },
        box);
    const RasterFrame& frame = grid.frame();
    CHECK(frame.dx <= 1 / std::max(by.first, by.second));
    CHECK(frame.dx >= 0.5 / std::max(by.first, by.second));
    CHECK(frame.dy == frame.dx);
    CHECK(frame.first.x <= box.low.x);
    CHECK(frame.first.y <= box.low.y);
    CHECK(grid.point(frame.columns - 1, frame.rows - 1).x >= box.high.x);
    CHECK(grid.point(frame.columns - 1, frame.rows - 1).y >= box.high.y);
  }
}
