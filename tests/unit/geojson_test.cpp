#include "geojson/geojson.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "driftmesh/error.hpp"
#include "geojson/read_input.hpp"
#include "geojson/rings_to_pslg.hpp"
#include "geojson_text.hpp"
#include "gis/projection.hpp"
#include "gis/transverse_mercator.hpp"
#include "property/cases.hpp"

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
