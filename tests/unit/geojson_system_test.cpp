#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <utility>

#include "geojson/read_input.hpp"
#include "geojson_text.hpp"
#include "gis/coordinates.hpp"
#include "gis/geographic_system.hpp"

// The coordinate systems that files of GeoJSON name.

using namespace driftmesh;
using namespace driftmesh::testing;

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
