#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "geojson/read_input.hpp"
#include "geojson_text.hpp"
#include "gis/transverse_mercator.hpp"
#include "property/cases.hpp"

// Domains across the 180th meridian.

using namespace driftmesh;
using namespace driftmesh::testing;

TEST_CASE("longitudes count on across the 180th meridian") {
  const std::string wrapped = "[[[-177.1,48.6],[179.6,49.0],[179.3,47.5],[-178.6,47.1],[-177.1,48.6]]]",
                    beyond = "[[[182.9,48.6],[179.6,49.0],[179.3,47.5],[181.4,47.1],[182.9,48.6]]]";
  const InputFile found = parse_geojson_input("x.json", polygon(wrapped));
  CHECK(found.projection == "UTM zone 1N");
  REQUIRE(found.pslg.points.size() == 4);
  CHECK(found.pslg.points[0] == utm(-177.1 + 360, 48.6, {1, true}));
  CHECK(std::abs(found.pslg.points[1].x - utm(-180.4, 49, {1, true}).x) < 1e-4);
  CHECK(parse_geojson_input("x.json", polygon(beyond)).pslg.points == found.pslg.points);
  // What only touches the meridian, or counts from 0 to 360, lies on one side of it.
  CHECK(parse_geojson_input("x.json", polygon("[[[-180,1],[-179,1],[-179,2],[-180,1]]]")).projection == "UTM zone 1N");
  CHECK(parse_geojson_input("x.json", polygon("[[[180,1],[181,1],[181,2],[180,1]]]")).projection == "UTM zone 1N");
  CHECK(parse_geojson_input("x.json", polygon("[[[179,1],[180,1],[180,2],[179,1]]]")).projection == "UTM zone 60N");
  CHECK(parse_geojson_input("x.json", polygon("[[[359,1],[1,1],[1,2],[359,1]]]")).projection == "UTM zone 31N");
}

TEST_CASE("an island that was cut along the 180th meridian is whole again") {
  const std::string west = "[[177,-3],[180,-3],[180,-1],[179,-1],[179,1],[180,1],[180,3],[177,3],[177,-3]]",
                    east = "[[-177,-3],[-180,-3],[-180,-1],[-179,-1],[-179,1],[-180,1],[-180,3],[-177,3],[-177,-3]]";
  const auto collection = [&](const char* first, const char* second) {
    return R"({"type": "FeatureCollection", "features": [)" + polygon("[" + west + "]", first) + "," +
           polygon("[" + east + "]", second) + "]}";
  };
  const Pslg joined = parse_geojson_input("x.json", collection("{}", "{}")).pslg;
  CHECK(joined.points.size() == 12);
  CHECK(joined.segments.size() == 12);
  // A border between regions, or between polygons with markers of their own, is one.
  CHECK(parse_geojson_input("x.json", collection(R"({"region": 1})", R"({"region": 2})")).pslg.segments.size() == 14);
  CHECK(parse_geojson_input("x.json", collection("{}", R"({"marker": 5})")).pslg.segments.size() == 14);
  CHECK(parse_geojson_input("x.json", collection(R"({"region": 1})", R"({"region": 1})")).pslg.segments.size() == 12);
}

namespace {

/// Between a border in the west and one in the east, from one height to the next, so that heights at which a border
/// crosses the meridian 0 are among them.
struct Band {
  std::vector<double> heights, west, east;
};

/// With eastings that 10 decimals hold.
Band random_band(std::mt19937_64& random) {
  const auto easting = [&] { return (static_cast<double>(random() % 4097) - 2048) / 1024; };
  Band band, whole;
  const std::size_t rows = 3 + random() % 6;
  for (std::size_t i = 0; i < rows; ++i) {
    const double a = easting(), b = easting();
    band.heights.push_back(static_cast<double>(i) / 4 + 0.125);
    band.west.push_back(std::min(a, b) - 1. / 64);
    band.east.push_back(std::max(a, b) + 1. / 64);
    if (random() % 5 == 0) band.west.back() = std::min(0., band.west.back());
  }
  for (std::size_t i = 0; i < rows; ++i) {
    whole.heights.push_back(band.heights[i]);
    whole.west.push_back(band.west[i]);
    whole.east.push_back(band.east[i]);
    if (i + 1 == rows) break;
    std::vector<std::pair<double, bool>> crossings;
    for (const auto* side : {&band.west, &band.east})
      if (((*side)[i] < 0) != ((*side)[i + 1] < 0) && (*side)[i] != 0 && (*side)[i + 1] != 0)
        crossings.push_back({(*side)[i] / ((*side)[i] - (*side)[i + 1]), side == &band.west});
    std::ranges::sort(crossings);
    for (const auto& [t, is_west] : crossings) {
      const double height = band.heights[i] + t * (band.heights[i + 1] - band.heights[i]);
      const auto at = [&](const std::vector<double>& side) {
        return std::round((side[i] + t * (side[i + 1] - side[i])) * 1024) / 1024;
      };
      whole.heights.push_back(height);
      whole.west.push_back(is_west ? 0 : at(band.west));
      whole.east.push_back(is_west ? at(band.east) : 0);
    }
  }
  return whole;
}

using Ring = std::vector<Point>;

/// Also with corners where the first and the last height cross the meridian 0.
Ring ring_between(const std::vector<double>& heights, const std::vector<double>& west,
                  const std::vector<double>& east) {
  Ring ring;
  const auto cross = [&](std::size_t i) {
    if (west[i] < 0 && east[i] > 0) ring.push_back({0, heights[i]});
  };
  cross(0);
  for (std::size_t i = 0; i < heights.size(); ++i) ring.push_back({east[i], heights[i]});
  cross(heights.size() - 1);
  for (std::size_t i = heights.size(); i-- > 0;)
    if (west[i] != east[i]) ring.push_back({west[i], heights[i]});
  return ring;
}

/// The parts of a band on one side of the meridian 0.
std::vector<Ring> parts_of(const Band& band, bool in_east) {
  std::vector<Ring> parts;
  std::vector<double> heights, west, east;
  const auto take = [&] {
    if (heights.size() > 1) parts.push_back(ring_between(heights, west, east));
    heights = west = east = {};
  };
  const auto has_part = [&](std::size_t i) { return in_east ? band.east[i] > 0 : band.west[i] < 0; };
  for (std::size_t i = 0; i < band.heights.size(); ++i) {
    heights.push_back(band.heights[i]);
    west.push_back(in_east ? std::max(0., band.west[i]) : band.west[i]);
    east.push_back(in_east ? band.east[i] : std::min(0., band.east[i]));
    if (!has_part(i)) {
      west.back() = east.back() = 0;
      take();
      heights = {band.heights[i]}, west = east = {0};
      if (i + 1 < band.heights.size() && !has_part(i + 1)) heights = west = east = {};
    }
  }
  take();
  return parts;
}

std::string written(Ring ring, std::mt19937_64& random, const std::function<double(double)>& longitude) {
  std::ranges::rotate(ring, ring.begin() + static_cast<std::ptrdiff_t>(random() % ring.size()));
  if (random() % 2 == 0) std::ranges::reverse(ring);
  ring.push_back(ring.front());
  std::string text;
  for (const Point& p : ring) text += fmt::format("{}[{},{}]", text.empty() ? "" : ",", longitude(p.x), p.y);
  return "[[" + text + "]]";
}

std::vector<std::pair<double, double>> sorted_points(const Pslg& pslg) {
  std::vector<std::pair<double, double>> points;
  for (const Point& p : pslg.points) points.push_back({p.x, p.y});
  std::ranges::sort(points);
  return points;
}

}  // namespace

TEST_CASE("bands across the 180th meridian are what they are across Greenwich, however they are cut and counted") {
  auto random = testing::seeded_generator("dateline");
  int cut = 0;
  for (int round = 0; round < 500; ++round) {
    CAPTURE(round);
    const Band band = random_band(random);
    const Pslg wanted = parse_geojson_input("x.json", polygon(written(ring_between(band.heights, band.west, band.east),
                                                                      random, [](double x) { return x; })))
                            .pslg;
    const auto turned = [](double x) { return x < 0 ? x + 180 : x - 180; };
    const auto beyond = [](double x) { return x + 180; };
    for (const auto& longitude : {std::function<double(double)>(turned), std::function<double(double)>(beyond)}) {
      const Pslg found =
          parse_geojson_input("x.json",
                              polygon(written(ring_between(band.heights, band.west, band.east), random, longitude)))
              .pslg;
      CHECK(sorted_points(found) == sorted_points(wanted));
      CHECK(found.segments.size() == wanted.segments.size());
    }
    std::vector<std::string> parts;
    for (const bool in_east : {false, true})
      for (const Ring& ring : parts_of(band, in_east))
        parts.push_back(written(ring, random, [&](double x) { return in_east ? x - 180 : x + 180; }));
    std::ranges::shuffle(parts, random);
    std::string all;
    for (const std::string& part : parts) all += (all.empty() ? "" : ",") + part;
    const Pslg found = parse_geojson_input("x.json", R"({"type": "MultiPolygon", "coordinates": [)" + all + "]}").pslg;
    CAPTURE(all);
    CHECK(sorted_points(found) == sorted_points(wanted));
    CHECK(found.segments.size() == wanted.segments.size());
    cut += parts.size() > 1 ? 1 : 0;
  }
  CHECK(cut > 300);
}
