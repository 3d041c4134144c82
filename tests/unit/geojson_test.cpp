#include "geojson/geojson.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "driftmesh/error.hpp"
#include "geojson/read_input.hpp"
#include "geojson/rings_to_pslg.hpp"
#include "gis/coordinates.hpp"
#include "gis/geographic_system.hpp"
#include "gis/projection.hpp"
#include "gis/transverse_mercator.hpp"
#include "property/cases.hpp"
#include "support/error_text.hpp"

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

/// The arc of a meridian of WGS 84 from the equator, by Simpson's rule on its radius of curvature.
double meridian_arc(double latitude) {
  constexpr double a = 6'378'137, f = 1 / 298.257223563, e2 = f * (2 - f);
  const auto radius = [&](double phi) { return a * (1 - e2) / std::pow(1 - e2 * std::pow(std::sin(phi), 2), 1.5); };
  constexpr int n = 2000;
  const double h = latitude * std::numbers::pi / 180 / n;
  double sum = radius(0) + radius(n * h);
  for (int i = 1; i < n; ++i) sum += (i % 2 == 0 ? 2 : 4) * radius(i * h);
  return sum * h / 3;
}

std::string error_of_text(const std::string& text) {
  return error_text<InputError>([&] { static_cast<void>(parse_geojson_input("coast.geojson", text)); });
}

std::string polygon(const std::string& rings, const std::string& properties = "{}") {
  return R"({"type": "Feature", "properties": )" + properties + R"(, "geometry": {"type": "Polygon", "coordinates": )" +
         rings + "}}";
}
std::string planar(const std::string& features) {
  return R"({"type": "FeatureCollection", "crs": {"type": "name", "properties": {"name": "EPSG:32618"}}, "features": [)" +
         features + "]}";
}

const std::string kSquare = "[[0,0],[10,0],[10,10],[0,10],[0,0]]";
const std::string kHole = "[[2,2],[2,8],[8,8],[8,2],[2,2]]";
const std::string kIsland = "[[4,4],[6,4],[6,6],[4,6],[4,4]]";

}  // namespace

TEST_CASE("zones are six degrees wide") {
  CHECK(utm_zone_of(-76, 38).name() == "UTM zone 18N");
  CHECK(utm_zone_of(-180, 1).number == 1);
  CHECK(utm_zone_of(179.999, 1).number == 60);
  CHECK(utm_zone_of(180, 1).number == 1);
  CHECK(utm_zone_of(0, -0.1).name() == "UTM zone 31S");
  CHECK(utm_zone_of(-0.1, 0).name() == "UTM zone 30N");
  CHECK(UtmZone{31, true}.central_meridian() == 3);
}

TEST_CASE("on the central meridian northings are arcs of the meridian, scaled") {
  for (const double latitude : {-79.0, -33.0, -1e-6, 0.0, 1.0, 38.0, 60.0, 83.9}) {
    CAPTURE(latitude);
    const UtmZone zone{18, latitude >= 0};
    const Point p = utm(-75, latitude, zone);
    CHECK(p.x == doctest::Approx(500'000).epsilon(1e-14));
    CHECK(std::abs(p.y - (zone.north ? 0 : 1e7) - 0.9996 * meridian_arc(latitude)) < 1e-6);
  }
}

// The map is conformal and fixed by its central meridian: that defines it.
TEST_CASE("the projection is conformal on the ellipsoid, and symmetric") {
  constexpr double a = 6'378'137, f = 1 / 298.257223563, e2 = f * (2 - f), radians = std::numbers::pi / 180;
  auto random = testing::seeded_generator("utm");
  std::uniform_real_distribution<double> off(-20, 20), latitudes(-80, 84);
  for (int round = 0; round < 500; ++round) {
    const double latitude = latitudes(random), away = off(random);
    CAPTURE(latitude);
    CAPTURE(away);
    const UtmZone zone{31, true};
    const auto at = [&](double east, double north) { return utm(3 + away + east, latitude + north, zone); };
    constexpr double h = 1e-3;
    const double s = std::sin(latitude * radians), w = std::sqrt(1 - e2 * s * s);
    const double per_east = a * std::cos(latitude * radians) / w * radians,
                 per_north = a * (1 - e2) / (w * w * w) * radians;
    const auto along = [&](double east, double north) {
      const Point p = at(east, north), q = at(-east, -north);
      return Point{(p.x - q.x) / 2, (p.y - q.y) / 2};
    };
    const Point e = along(h, 0), n = along(0, h);
    const double scale_east = std::hypot(e.x, e.y) / (h * per_east),
                 scale_north = std::hypot(n.x, n.y) / (h * per_north);
    CHECK(scale_east == doctest::Approx(scale_north).epsilon(1e-6));
    CHECK(std::abs(e.x * n.x + e.y * n.y) < 1e-6 * std::hypot(e.x, e.y) * std::hypot(n.x, n.y));
    CHECK(e.x * n.y - e.y * n.x > 0);
    const Point mirrored = utm(3 - away, latitude, zone);
    CHECK(at(0, 0).x - 500'000 == doctest::Approx(500'000 - mirrored.x).epsilon(1e-12));
    CHECK(at(0, 0).y == doctest::Approx(mirrored.y).epsilon(1e-12));
  }
}

TEST_CASE("polygons, holes and islands in them become a domain with polygons and markers") {
  const auto [pslg, projection, warnings, from_lonlat] = parse_geojson_input(
      "x.json", planar(polygon("[" + kSquare + "," + kHole + "]", R"({"region": 7, "max_area": 0.5})") + "," +
                       polygon("[" + kIsland + "]", R"({"marker": 9})")));
  CHECK(projection == "UTM zone 18N");
  CHECK_FALSE(from_lonlat);
  CHECK(warnings.empty());
  CHECK(pslg.points.size() == 12);
  CHECK(pslg.segments.size() == 12);
  CHECK(std::ranges::count(pslg.segments, 1, &Pslg::Segment::marker) == 4);
  CHECK(std::ranges::count(pslg.segments, 2, &Pslg::Segment::marker) == 4);
  CHECK(std::ranges::count(pslg.segments, 9, &Pslg::Segment::marker) == 4);
  CHECK(pslg.holes.empty());
  REQUIRE(pslg.polygons.size() == 2);
  CHECK(pslg.polygons[0] == Pslg::Polygon{{{0, 1, 2, 3}, {4, 5, 6, 7}}, 0, 1});
  CHECK(pslg.polygons[1] == Pslg::Polygon{{{8, 9, 10, 11}}, -1, 2});
  REQUIRE(pslg.regions.size() == 1);
  CHECK(pslg.regions[0].attribute == 7);
  CHECK(pslg.regions[0].max_area == 0.5);
}

TEST_CASE("borders of two polygons, and regions of equal values, are there once") {
  const std::string region = R"({"region": 3})";
  const Pslg pslg = parse_geojson_input("x.json", planar(polygon("[" + kSquare + "," + kHole + "]", region) + "," +
                                                         polygon("[" + kHole + "]", region) + "," +
                                                         polygon("[" + kIsland + "]", R"({"region": 4})")))
                        .pslg;
  CHECK(pslg.segments.size() == 12);
  CHECK(pslg.regions.size() == 2);
  CHECK(pslg.polygons[0].region == pslg.polygons[1].region);
  CHECK(pslg.polygons[1].rings[0] == pslg.polygons[0].rings[1]);
}

TEST_CASE("lines give their markers to the coast that they follow, and are constraints elsewhere") {
  const Pslg pslg =
      parse_geojson_input(
          "x.json",
          planar(
              polygon("[" + kSquare + "]") +
              R"(, {"type": "Feature", "properties": {"boundary": "open"}, "geometry": {"type": "LineString", "coordinates": [[10,10],[10,0]]}})" +
              R"(, {"type": "Feature", "properties": null, "geometry": {"type": "MultiLineString", "coordinates": [[[1,1],[5,5, 3]]]}})" +
              R"(, {"type": "Feature", "properties": {"other": 1}, "geometry": {"type": "Point", "coordinates": [2,7]}})"))
          .pslg;
  CHECK(pslg.points.size() == 7);
  CHECK(pslg.segments.size() == 5);
  CHECK(std::ranges::count(pslg.segments, 3, &Pslg::Segment::marker) == 1);
  CHECK(std::ranges::count(pslg.segments, 0, &Pslg::Segment::marker) == 1);
}

TEST_CASE("degrees become meters in the zone of their middle") {
  const auto [pslg, projection, warnings, from_lonlat] =
      parse_geojson_input("x.geojson", polygon("[[[-76,37],[-75.5,37],[-75.5,38],[-76,37]]]"));
  CHECK(projection == "UTM zone 18N");
  CHECK(from_lonlat);
  CHECK(warnings.empty());
  REQUIRE(pslg.points.size() == 3);
  CHECK(pslg.points[0] == utm(-76, 37, {18, true}));
  CHECK(error_of_text(polygon("[" + kSquare.substr(0, kSquare.size() - 1) + ",[500000,1]]]"))
            .find("no longitude and latitude") != std::string::npos);
  CHECK(error_of_text(polygon("[[[-60,0],[60,0],[60,1],[-60,0]]]")).find("60 degrees from its middle") !=
        std::string::npos);
  CHECK(error_of_text(polygon("[[[110,0],[140,0],[-170,0],[-130,1],[110,0]]]")).find("60 degrees from its middle") !=
        std::string::npos);
  CHECK(error_of_text(polygon("[[[361,0],[362,0],[362,1],[361,0]]]")).find("no longitude") != std::string::npos);
}

TEST_CASE("where no zone serves the plane is stereographic, around the middle or a pole") {
  const auto projection = [](const std::string& ring) {
    return parse_geojson_input("x.json", polygon("[" + ring + "]")).projection;
  };
  CHECK(projection("[[0,80],[1,80],[1,85],[0,80]]") == "stereographic at 1 83");
  CHECK(projection("[[10,-79],[11,-79],[11,-80.1],[10,-79]]") == "stereographic at 11 -80");
  CHECK(projection("[[-140,60],[-50,60],[-50,75],[-140,60]]") == "stereographic at -95 68");
  CHECK(projection("[[-150,75],[120,75],[0,85],[-150,75]]") == "stereographic at 0 90");
  CHECK(projection("[[-50,40],[40,40],[40,45],[-50,40]]") == "stereographic at -5 43");
  CHECK(projection("[[141,40],[-145,40],[-145,45],[141,40]]") == "UTM zone 60N");
  CHECK(projection("[[130,40],[-140,40],[-140,45],[130,40]]") == "stereographic at 175 43");
  // All around a pole, in whatever way the file says so.
  const std::string caps[] = {
      "[[-180,66],[180,66],[180,90],[-180,90],[-180,66]]", "[[0,66],[90,66],[180,66],[-90,66],[0,66]]",
      "[[-180,66],[-90,66],[0,66],[90,66],[180,66],[180,80],[180,90],[-180,90],[-180,80],[-180,66]]"};
  for (const std::string& cap : caps) {
    CAPTURE(cap);
    const InputFile found = parse_geojson_input("x.json", polygon("[" + cap + "]"));
    CHECK(found.projection == "stereographic at 0 90");
    CHECK(found.pslg.points.size() == found.pslg.segments.size());
    CHECK(found.pslg.points.size() >= 90);
    for (const Point& p : found.pslg.points) CHECK(std::abs(std::hypot(p.x - 1e7, p.y - 1e7) - 2'718'967) < 1);
  }
}

// As for the zones.
TEST_CASE(
    "the stereographic projection is conformal on the ellipsoid, true to scale at its center, and has an inverse") {
  constexpr double a = 6'378'137, f = 1 / 298.257223563, e2 = f * (2 - f), radians = std::numbers::pi / 180;
  auto random = testing::seeded_generator("stereographic");
  std::uniform_real_distribution<double> longitudes(-180, 180), latitudes(-90, 90), off(-50, 50);
  for (int round = 0; round < 500; ++round) {
    const Point center{std::round(longitudes(random)),
                       round % 3 == 0 ? (round % 2 == 0 ? 90.0 : -90.0) : std::round(latitudes(random))};
    const Projection plane{Stereographic(center)};
    const double longitude = center.x + off(random), latitude = std::clamp(center.y + off(random), -89.9, 89.9);
    CAPTURE(plane.name());
    CAPTURE(longitude);
    CAPTURE(latitude);
    const auto at = [&](double east, double north) { return plane.plane({longitude + east, latitude + north}); };
    constexpr double h = 1e-4;
    const double s = std::sin(latitude * radians), w = std::sqrt(1 - e2 * s * s);
    const double per_east = a * std::cos(latitude * radians) / w * radians,
                 per_north = a * (1 - e2) / (w * w * w) * radians;
    const auto along = [&](double east, double north) {
      const Point p = at(east, north), q = at(-east, -north);
      return Point{(p.x - q.x) / 2, (p.y - q.y) / 2};
    };
    const Point e = along(h, 0), n = along(0, h);
    const double scale_east = std::hypot(e.x, e.y) / (h * per_east),
                 scale_north = std::hypot(n.x, n.y) / (h * per_north);
    CHECK(scale_east == doctest::Approx(scale_north).epsilon(1e-5));
    CHECK(scale_east > 1 - 1e-5);
    CHECK(std::abs(e.x * n.x + e.y * n.y) < 1e-5 * std::hypot(e.x, e.y) * std::hypot(n.x, n.y));
    CHECK(e.x * n.y - e.y * n.x > 0);
    const Point back = plane.geographic(at(0, 0));
    CHECK(std::abs(std::remainder(back.x - longitude, 360)) * std::cos(latitude * radians) < 1e-12);
    CHECK(std::abs(back.y - latitude) < 1e-12);
    CHECK(projection_named(plane.name())->name() == plane.name());
    if (std::abs(center.y) > 89) continue;
    const Point near = plane.plane({center.x, center.y + 1e-4});
    CHECK(near.y - 1e7 == doctest::Approx(meridian_arc(center.y + 1e-4) - meridian_arc(center.y)).epsilon(1e-6));
  }
  CHECK_FALSE(projection_named("stereographic at 0"));
  CHECK_FALSE(projection_named("stereographic at 0 91"));
  CHECK_FALSE(projection_named("stereographic at 0 90 "));
  CHECK(Projection(Stereographic({5, -90})).plane({77, -90}) == Point{1e7, 1e7});
}

TEST_CASE("what coordinates are is told and understood") {
  for (const char* text : {"UTM zone 18N", "UTM zone 18N from lonlat", "lonlat from stereographic at 0 90",
                           "EPSG:3035 from UTM zone 32N", "EPSG:3035 from UTM zone 32N from lonlat"}) {
    CAPTURE(text);
    REQUIRE(coordinates_from(text));
    CHECK(coordinates_from(text)->text() == text);
  }
  for (const char* text : {"", "UTM zone 61N", "lonlat", "from lonlat", "EPSG:x from UTM zone 18N"})
    CHECK_FALSE(coordinates_from(text));
  // Codes of the same plane, and of degrees, need nobody else.
  const Point p{440'000, 4'100'000};
  CHECK(from_plane("UTM zone 18N", "EPSG:32618", "x")(p) == p);
  CHECK(from_plane("UTM zone 18N", "EPSG:4326", "x")(p) == from_plane("UTM zone 18N", "lonlat", "x")(p));
  const Point back = to_plane("UTM zone 18N", "lonlat", "x")(from_plane("UTM zone 18N", "lonlat", "x")(p));
  CHECK(std::hypot(back.x - p.x, back.y - p.y) < 1e-8);
}

namespace {

std::string in_system(const std::string& name, const std::string& ring) {
  return R"({"type": "Polygon", "crs": {"type": "name", "properties": {"name": ")" + name + R"("}}, "coordinates": [)" +
         ring + "]}";
}

}  // namespace

TEST_CASE("whatever system of longitudes and latitudes a file names, it is in degrees") {
  const std::string ring = "[[-70,41],[-69.9,41],[-69.9,41.1],[-70,41.1],[-70,41]]";
  const InputFile plain = parse_geojson_input("x.json", polygon("[" + ring + "]"));
  for (const char* name : {"urn:ogc:def:crs:EPSG::4269",
                           "EPSG:4269",
                           "epsg:4326",
                           "urn:ogc:def:crs:OGC:1.3:CRS84",
                           "urn:ogc:def:crs:OGC:1.3:CRS83",
                           "http://www.opengis.net/def/crs/EPSG/0/4258",
                           "http://www.opengis.net/gml/srs/epsg.xml#4283",
                           "urn:ogc:def:crs:EPSG:6.9:4617",
                           "EPSG:4674",
                           "EPSG:4612",
                           "EPSG:6318",
                           "EPSG:7844",
                           "EPSG:8860",
                           "EPSG:4979",
                           "EPSG:4490",
                           "EPSG:4267",
                           "EPSG:6668",
                           "EPSG:9000",
                           "EPSG:3819",
                           "EPSG:20041",
                           "GCS_North_American_1983"}) {
    CAPTURE(name);
    const InputFile found = parse_geojson_input("x.json", in_system(name, ring));
    CHECK(found.projection == "UTM zone 19N");
    CHECK(found.pslg.points == plain.pslg.points);
    CHECK(found.warnings.empty());
  }
  for (const int code : {0, 1, 3818, 3857, 2154, 4978, 4328, 4087, 4217, 4399, 4822, 4807, 32619, 20042, 1'000'000})
    CHECK(!is_geographic_code(code));
}

TEST_CASE("coordinates in an unknown system are those of a plane, with a warning") {
  const std::string degrees = "[[-70,41],[-69.9,41],[-69.9,41.1],[-70,41]]",
                    meters = "[[700000,6000000],[700900,6000000],[700000,6000900],[700000,6000000]]";
  for (const char* name : {"EPSG:2154", "unknown", "ESRI:104199", "EPSG:4807"}) {
    CAPTURE(name);
    const InputFile found = parse_geojson_input("x.json", in_system(name, degrees));
    CHECK(found.projection.empty());
    CHECK(found.pslg.points[0] == Point{-70, 41});
    REQUIRE(found.warnings.size() == 1);
    CHECK(found.warnings[0].find("'" + std::string(name) + "'") != std::string::npos);
    CHECK(found.warnings[0].find("look like degrees") != std::string::npos);
    const InputFile far = parse_geojson_input("x.json", in_system(name, meters));
    CHECK(far.projection.empty());
    CHECK(far.warnings.size() == (std::string(name) == "unknown" ? 0 : 1));  // a file that says nothing is in a plane
  }
  CHECK(parse_geojson_input("x.json", in_system("meters", degrees)).warnings.empty());
}

TEST_CASE("a member crs names a system in one of three ways, or is refused") {
  const auto with = [](const std::string& crs) {
    return R"({"type": "Polygon", "crs": )" + crs +
           R"(, "coordinates": [[[-70,41],[-69.9,41],[-69.9,41.1],[-70,41]]]})";
  };
  const auto warnings = [&](const std::string& crs) { return parse_geojson_input("x.json", with(crs)).warnings; };
  for (const char* degrees :
       {"null", R"({"type": "EPSG", "properties": {"code": 4283}})",
        R"({"type": "EPSG", "properties": {"code": "4326"}})",
        R"({"type": "link", "properties": {"href": "http://www.opengis.net/def/crs/EPSG/0/4326"}})"}) {
    CAPTURE(degrees);
    CHECK(parse_geojson_input("x.json", with(degrees)).projection == "UTM zone 19N");
    CHECK(warnings(degrees).empty());
  }
  for (const auto& [crs, name] :
       {std::pair{R"({"type": "EPSG", "properties": {"code": 99999}})", "'EPSG:99999'"},
        {R"({"type": "link", "properties": {"href": "http://example.com/crs/42", "type": "proj4"}})",
         "'http://example.com/crs/42'"}}) {
    CAPTURE(crs);
    REQUIRE(warnings(crs).size() == 1);
    CHECK(warnings(crs)[0].find(name) != std::string::npos);
  }
  for (const char* nothing : {"{}", "[]", "7", R"("EPSG:4326")", R"({"type": "name", "properties": {}})",
                              R"({"type": "name", "properties": {"name": 4326}})",
                              R"({"type": 5, "properties": {"code": 4326}})", R"({"properties": 1})"})
    CHECK(error_of_text(with(nothing)).find("names no system") != std::string::npos);
}

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

TEST_CASE("edges take the vertices that lie on them in degrees") {
  const auto corners_of = [](const std::string& features) {
    const Pslg pslg =
        parse_geojson_input("x.json", R"({"type": "FeatureCollection", "features": [)" + features + "]}").pslg;
    return pslg.polygons.at(0).rings.at(0).size();
  };
  const auto line = [](const std::string& points) {
    return R"({"type": "Feature", "properties": {}, "geometry": {"type": "LineString", "coordinates": )" + points +
           "}}";
  };
  const std::string large = polygon("[[[-71,40],[-69,40],[-69,41],[-71,41],[-71,40]]]");
  CHECK(corners_of(large) == 4);
  CHECK(corners_of(large + "," + line("[[-71,40],[-70,40],[-69,40]]")) == 5);
  CHECK(corners_of(large + "," + line("[[-70,40.5],[-70,40.00001]]")) == 4);
  CHECK(corners_of(large + "," + polygon("[[[-70.5,41],[-70.2,41],[-70.3,42],[-70.5,41]]]")) == 6);
  // On a slope, in double precision.
  const std::string sloped = polygon("[[[-71,40],[-69.9,40.7],[-71,41],[-71,40]]]");
  CHECK(corners_of(sloped + "," + line("[[-70.67,40.21],[-70.5,40]]")) == 4);
}

TEST_CASE("lines and points on the edge of a polygon leave it where it is, and polygons bend it") {
  const auto collection = [](const std::string& features) {
    return parse_geojson_input("x.json", R"({"type": "FeatureCollection", "features": [)" + features + "]}").pslg;
  };
  const auto line = [](const std::string& points) {
    return R"({"type": "Feature", "properties": {}, "geometry": {"type": "LineString", "coordinates": )" + points +
           "}}";
  };
  const auto area = [](const Pslg& pslg) {  // only the first polygon
    const auto& ring = pslg.polygons.at(0).rings.at(0);
    const Point o = pslg.points[ring[0]];
    double sum = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point &a = pslg.points[ring[i]], &b = pslg.points[ring[(i + 1) % ring.size()]];
      sum += ((a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x)) / 2;
    }
    return sum;
  };
  const std::string large = polygon("[[[-71,40],[-69,40],[-69,41],[-71,41],[-71,40]]]");
  const double alone = area(collection(large));
  CHECK(area(collection(large + "," + line("[[-71,40],[-70,40],[-69,40]]"))) == doctest::Approx(alone).epsilon(1e-14));
  CHECK(area(collection(line("[[-70.5,40.5],[-70.3,40]]") + "," + large + "," + line("[[-70.2,42],[-70.2,40]]"))) ==
        doctest::Approx(alone).epsilon(1e-14));
  const std::string south = polygon("[[[-70.5,40],[-70,39],[-69.5,40],[-70.5,40]]]");
  const double bent = area(collection(large + "," + south));
  CHECK(bent > alone * 1.001);
  // On the part of the edge between the corners of the other polygon.
  const Pslg all = collection(large + "," + south + "," + line("[[-70,40],[-69.75,40],[-69.75,41]]"));
  CHECK(all.polygons.at(0).rings.at(0).size() == 9);
  CHECK(area(all) == doctest::Approx(bent).epsilon(1e-14));
}

TEST_CASE("names belong to the region or the marker that a feature has by its number") {
  const auto names = [](const std::string& first, const std::string& second) {
    const std::string text =
        planar(polygon("[" + kSquare + "," + kHole + "]", first) + "," + polygon("[" + kIsland + "]", second));
    return parse_geojson_input("x.json", text).pslg.names;
  };
  CHECK(names(R"({"region": 7.5, "marker": 4, "name": "bay"})", R"({"marker": 9, "name": "\u00dcberlauf"})") ==
        Names{{{9,
                "\xC3\x9C"
                "berlauf"}},
              {{7.5, "bay"}}});
  CHECK(names(R"({"boundary": "land", "name": "Kent"})", R"({"name": "Smith Island"})").empty());
  CHECK(names(R"({"marker": 9, "name": 17})", R"({"marker": 9, "name": null})").empty());
  CHECK(names(R"({"marker": 9, "name": "reef"})", R"({"marker": 9, "name": "reef"})").markers.size() == 1);
  CHECK_THROWS_WITH_AS((void)names(R"({"marker": 9, "name": "reef"})", R"({"marker": 9, "name": "rock"})"),
                       doctest::Contains("feature 2 calls its marker 'rock', but another feature 'reef'"), InputError);
}

TEST_CASE("what is wrong is named, with the line or the feature") {
  CHECK(error_of_text("{\"type\":\n\"Feature\",\n,}").starts_with("coast.geojson:3: is not valid JSON"));
  CHECK(error_of_text("").starts_with("coast.geojson:1: is not valid JSON"));
  CHECK(error_of_text("[1, 2]").find("has no type") != std::string::npos);
  CHECK(error_of_text(planar("")).find("no geometry") != std::string::npos);
  const auto second = [](const std::string& feature) {
    return error_of_text(planar(polygon("[" + kSquare + "]") + "," + feature));
  };
  CHECK(second("7").find("feature 2 has no type") != std::string::npos);
  CHECK(second(polygon("[[[0,0],[1,\"1\"],[0,1]]]")).find("no array of two numbers") != std::string::npos);
  CHECK(second(polygon("[" + kHole + "]", R"({"marker": 1.5})")).find("no whole number") != std::string::npos);
  CHECK(second(polygon("[" + kHole + "]", R"({"marker": 1e300})")).find("no whole number") != std::string::npos);
  CHECK(second(polygon("[" + kHole + "]", R"({"boundary": "sea"})")).find("unknown kind") != std::string::npos);
  CHECK(second(polygon("[" + kHole + "]", R"({"max_area": 0})")).find("not positive") != std::string::npos);
  CHECK(second(R"({"type": "Feature", "geometry": {"type": "Circle", "coordinates": []}})").find("unknown type") !=
        std::string::npos);
  std::string deep = R"({"type": "Point", "coordinates": [0, 0]})";
  for (int i = 0; i < 20; ++i) deep = R"({"type": "GeometryCollection", "geometries": [)" + deep + "]}";
  CHECK(error_of_text(deep).find("nested too deeply") != std::string::npos);
  CHECK(error_of_text("{\"type\": \"Point\", \"coordinates\": [1e999, 0]}") != "no error");
  CHECK(error_of_text(std::string(100'000, '[')) != "no error");
}

TEST_CASE("files with random edits are read, or refused with an InputError") {
  const std::string whole = planar(polygon("[" + kSquare + "," + kHole + "]", R"({"marker": 3, "region": 1})") + "," +
                                   polygon("[" + kIsland + "]", R"({"boundary": "land"})"));
  auto random = testing::seeded_generator("geojson edits");
  int accepted = 0;
  for (int round = 0; round < 5000; ++round) {
    std::string text = whole;
    for (std::uint64_t edits = 1 + random() % 3; edits > 0; --edits) {
      const std::size_t at = random() % text.size();
      switch (random() % 3) {
        case 0:
          text.erase(at, 1 + random() % 4);
          break;
        case 1:
          text.insert(at, 1, "0123456789-.,[]{}\"eE"[random() % 20]);
          break;
        default:
          text[at] = static_cast<char>(random());
      }
      if (text.empty()) break;
    }
    accepted += error_of_text(text) == "no error" ? 1 : 0;
  }
  CHECK(accepted > 100);
  CHECK(accepted < 4900);
}

TEST_CASE("a system that is a UTM zone is known by its name, and coordinates remain") {
  const auto in_system = [](const std::string& name) {
    return parse_geojson_input("x.json", R"({"type": "Polygon", "crs": {"type": "name", "properties": {"name": ")" +
                                             name + R"("}}, "coordinates": [[[0,0],[10,0],[10,10],[0,0]]]})");
  };
  CHECK(in_system("urn:ogc:def:crs:EPSG::32618").projection == "UTM zone 18N");
  CHECK(in_system("EPSG:32733").projection == "UTM zone 33S");
  CHECK(in_system("EPSG:3035").projection.empty());
  CHECK(in_system("EPSG:32733").pslg.points[1] == Point{10, 0});
  CHECK(in_system("EPSG:4326").projection == "UTM zone 31N");
}

TEST_CASE("Web Mercator's meters, which are none, become meters") {
  // 10 km on a side around 76 degrees west, 37 degrees north; corners by the formulas of the projection.
  const auto area = [](const std::string& name, auto&& project) {
    std::string text =
        R"({"type": "Polygon", "crs": {"type": "name", "properties": {"name": ")" + name + R"("}}, "coordinates": [[)";
    for (const auto& [dx, dy] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}}) {
      const auto [x, y] = project(-76 + 0.1124 * dx, 37 + 0.0901 * dy);
      char position[80];
      std::snprintf(position, sizeof position, "[%.9f,%.9f],", x, y);
      text += position;
    }
    text.pop_back();
    const InputFile input = parse_geojson_input("x.json", text + "]]}");
    CHECK(input.projection == "UTM zone 18N");
    double doubled = 0;
    const auto& p = input.pslg.points;
    for (std::size_t i = 0; i < 4; ++i) doubled += p[i].x * p[(i + 1) % 4].y - p[(i + 1) % 4].x * p[i].y;
    return doubled / 2;
  };
  constexpr double kRadius = 6378137, kRadians = std::numbers::pi / 180, kEccentricity = 0.0818191908426215;
  const auto degrees = [](double x, double y) { return std::pair{x, y}; };
  const auto web = [](double x, double y) {
    return std::pair{kRadius * kRadians * x, kRadius * std::asinh(std::tan(kRadians * y))};
  };
  const auto world = [](double x, double y) {
    const double sine = std::sin(kRadians * y);
    return std::pair{kRadius * kRadians * x,
                     kRadius * (std::atanh(sine) - kEccentricity * std::atanh(kEccentricity * sine))};
  };
  const double right = area("EPSG:4326", degrees);
  CHECK(right == doctest::Approx(1e8).epsilon(1e-3));
  for (const char* name : {"EPSG:3857", "urn:ogc:def:crs:EPSG::3857", "EPSG:900913", "ESRI:102100", "EPSG:3785"})
    CHECK(area(name, web) == doctest::Approx(right).epsilon(1e-9));
  CHECK(area("urn:ogc:def:crs:EPSG::3395", world) == doctest::Approx(right).epsilon(1e-9));
}
