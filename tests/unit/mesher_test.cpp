#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "driftmesh/error.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/cdt.hpp"
#include "mesh/exceptions.hpp"
#include "mesh/narrow_place.hpp"
#include "mesh/to_piece.hpp"
#include "small_domains.hpp"
#include "support/made_mesh.hpp"
#include "verify/report_text.hpp"
#include "verify/verify.hpp"

// Domains that are triangulated, and meshed in one call. The refiner by itself is in refiner_test.cpp.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

void add_ring(Pslg& pslg, Point center, double radius, int n, int marker) {
  const auto first = static_cast<std::int32_t>(pslg.points.size());
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n;
    pslg.points.push_back({center.x + radius * std::cos(angle), center.y + radius * std::sin(angle)});
    pslg.segments.push_back({first + i, first + (i + 1) % n, marker});
  }
}

double total_area(const Triangulation& mesh) {
  return summarize_angles(mesh).total_area;
}

/// Checks that the mesh meets the bounds of the request, but for the angles that the verifier accepts.
void check_mesh(const Made& made, const Pslg& pslg, const job::Request& request) {
  const VerifyOptions options{.min_angle = request.bounds.angle, .plain = request.bounds};
  const VerifyReport report = verify(made.mesh, pslg, options);
  CHECK_MESSAGE(report.accepted(), report_text(report, options));
}

/// The number of triangles that the summary lists for this reason.
std::int64_t listed(const job::RunRecord& record, const std::string& cause) {
  std::int64_t count = 0;
  for (const auto& group : record.exceptions)
    if (group.cause == cause) count += group.count;
  return count;
}
constexpr const char* kLarge = "area or size bound missed";
constexpr const char* kNoRoom = "no room between coordinates";

}  // namespace

TEST_CASE("a rectangle becomes two triangles") {
  const Triangulation mesh = triangulate(rectangle(2, 1));
  CHECK(mesh.live_triangles() == 2);
  CHECK(mesh.live_vertices() == 4);
  CHECK(total_area(mesh) == 2);
  check_valid(mesh);
}

TEST_CASE("holes are carved and regions labeled") {
  Pslg pslg = rectangle(4, 2);
  pslg.points.push_back({2, 0});
  pslg.points.push_back({2, 2});
  pslg.segments = {{0, 4, 1}, {4, 1, 1}, {1, 2, 2}, {2, 5, 3}, {5, 3, 3}, {3, 0, 4}, {4, 5, 9}};
  add_ring(pslg, {1, 1}, 0.5, 16, 7);
  pslg.holes = {{1, 1}};
  pslg.regions = {{{0.1, 0.1}, 10, 0}, {{3, 1}, 20, 0}};
  const Triangulation mesh = triangulate(pslg);
  check_valid(mesh);
  const double ring = 16 * 0.5 * 0.5 * 0.5 * std::sin(2 * std::numbers::pi / 16);
  CHECK(total_area(mesh) == doctest::Approx(8 - ring));
  double left = 0, right = 0;
  for (const TriangleId t : ids_of(mesh.triangles)) {
    REQUIRE(mesh.region[t] != 0);
    (mesh.region[t] == 1 ? left : right) += signed_area(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2));
  }
  CHECK(left == doctest::Approx(4 - ring));
  CHECK(right == doctest::Approx(4));
}

TEST_CASE("points without segments are meshed up to their convex hull") {
  Pslg pslg;
  std::mt19937 random(5);
  std::uniform_int_distribution<int> coordinate(0, 30);  // many collinear and cocircular points
  for (int i = 0; i < 31; ++i)
    for (int j = 0; j < 31; ++j)
      if (coordinate(random) > 10) pslg.points.push_back({double(i), double(j)});
  for (const Point corner : {Point{0, 0}, Point{30, 0}, Point{30, 30}, Point{0, 30}})
    if (std::find(pslg.points.begin(), pslg.points.end(), corner) == pslg.points.end()) pslg.points.push_back(corner);
  const Triangulation mesh = triangulate(pslg);
  check_valid(mesh);
  CHECK(mesh.live_vertices() == pslg.points.size());
  CHECK(total_area(mesh) == 900);
}

TEST_CASE("inputs that enclose nothing are rejected with the cause") {
  Pslg open = rectangle(1, 1);
  open.segments.pop_back();
  CHECK_THROWS_WITH_AS(triangulate(open), doctest::Contains("outer boundary is open"), Error);
  Pslg emptied = rectangle(1, 1);
  emptied.holes = {{0.5, 0.5}};
  CHECK_THROWS_WITH_AS(triangulate(emptied), doctest::Contains("hole points remove"), Error);
  Pslg line;
  line.points = {{0, 0}, {1, 1}, {2, 2}, {3, 3}};
  CHECK_THROWS_WITH_AS(triangulate(line), doctest::Contains("one line"), Error);
  Pslg crossing = rectangle(1, 1);
  crossing.segments.push_back({0, 2, 0});
  crossing.segments.push_back({1, 3, 0});
  CHECK_THROWS_WITH_AS(triangulate(crossing), doctest::Contains("crosses another"), Error);
}

TEST_CASE("long segments are forced through many triangles, also next to the outer boundary") {
  for (const unsigned seed : {1U, 2U, 3U}) {
    CAPTURE(seed);
    constexpr int kStrips = 10;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    Pslg pslg = rectangle(1, 1);
    for (int i = 0; i < 500; ++i) pslg.points.push_back({unit(random), unit(random)});
    for (int strip = 0; strip < kStrips; ++strip) {
      pslg.segments.push_back({static_cast<std::int32_t>(pslg.points.size()),
                               static_cast<std::int32_t>(pslg.points.size() + 1), 5 + strip});
      for (const double x : {0.05 * unit(random), 1 - 0.05 * unit(random)})
        pslg.points.push_back({x, (strip + unit(random)) / kStrips});
    }
    const Triangulation mesh = triangulate(pslg);
    check_valid(mesh);
    const Mesh piece = to_piece(mesh, pslg);
    for (const Pslg::Segment& s : pslg.segments)
      CHECK(std::count_if(piece.edges.begin(), piece.edges.end(), [&](const Mesh::Edge& e) {
              return std::minmax(e.a, e.b) == std::minmax(s.a, s.b) && e.marker == s.marker;
            }) == 1);
  }
}

TEST_CASE("refinement meets the bounds on area and angle") {
  for (const double angle : {0.0, 20.0, 30.0, 33.0}) {
    Pslg pslg = rectangle(2, 1);
    add_ring(pslg, {0.7, 0.5}, 0.2, 32, 5);
    pslg.holes = {{0.7, 0.5}};
    const job::Request request = bounded(angle, 1e-4);
    const Made mesh = made(pslg, request);
    CAPTURE(angle);
    check_mesh(mesh, pslg, request);
    CHECK(mesh.record.exceptions.empty());
    CHECK(mesh.record.counters.given_up == 0);
    CHECK(mesh.record.complete);
    CHECK(mesh.record.shape.smallest >= angle);
  }
}

TEST_CASE("the narrowest place between two segments is found, with a forecast of its triangles") {
  const auto slit = [](double x0, double x1, double width, double rise) {
    Pslg pslg;
    pslg.points = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-0.5, 0}, {0.5, 0}, {x0, width}, {x1, width + rise}};
    pslg.segments = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 0, 1}, {4, 5, 2}, {6, 7, 2}};
    return pslg;
  };
  for (const Pslg& pslg : {slit(-0.5, 0.5, 1e-3, 0), slit(-0.3, 0.6, 1e-4, 0), slit(-0.3, 0.7, 1e-3, 1e-3)}) {
    const auto place = find_narrow_place(triangulate(pslg));
    REQUIRE(place);
    const double width = pslg.points[6].y;
    CHECK(place->width == doctest::Approx(width).epsilon(1e-9));
    CHECK(place->length == doctest::Approx(0.5 - pslg.points[6].x));
    const auto triangles = static_cast<double>(made(pslg, bounded(20)).mesh.triangles.size());
    CHECK(place->triangles > triangles / 2);
    CHECK(place->triangles < triangles * 2);
  }
  // A point near a segment, or segments that meet, do not count.
  Pslg point = slit(0.1, 0.1, 1e-6, 0.5);
  CHECK_FALSE(find_narrow_place(triangulate(point)));
  Pslg wedge = slit(0, 0, 0, 0);
  wedge.points.resize(7);
  wedge.points[6] = {0.3, 1e-6};
  wedge.segments.back() = {4, 6, 2};
  CHECK_FALSE(find_narrow_place(triangulate(wedge)));
}

TEST_CASE("refinement terminates at small angles of the input, which are the only exceptions") {
  for (unsigned seed = 1; seed <= 6; ++seed)
    for (const int wedges : {3, 7, 20, 40})
      for (const double angle : {20.0, 33.0}) {
        CAPTURE(seed);
        CAPTURE(wedges);
        const Pslg pslg = fan(seed, wedges);
        const job::Request request = bounded(angle, 0.01);
        const Made mesh = made(pslg, request);
        check_mesh(mesh, pslg, request);
        CHECK(listed(mesh.record, kLarge) == 0);  // the area bound holds at small angles, too
        CHECK(listed(mesh.record, kNoRoom) == 0);
        CHECK(mesh.record.shape.total_area == doctest::Approx(4).epsilon(1e-12));
      }
}

TEST_CASE("a sliver between two tiny corners on one segment costs the logarithm of its height") {
  const auto sliver = [](double foot, double height, bool surrounded) {
    Pslg pslg;
    pslg.points = {{0, 0}, {1, 0}, {foot, height}};
    pslg.segments = {{0, 1, 1}, {1, 2, 2}, {2, 0, 3}};
    if (!surrounded) return pslg;
    for (const Point& p : {Point{-1, -1}, Point{2, -1}, Point{2, 1}, Point{-1, 1}}) pslg.points.push_back(p);
    for (const auto& [a, b] : {std::pair(3, 4), std::pair(4, 5), std::pair(5, 6), std::pair(6, 3)})
      pslg.segments.push_back({a, b, 0});
    return pslg;
  };
  for (const bool surrounded : {false, true})
    for (const double foot : {0.5, 0.45, 0.3, 0.7, 0.1, 0.98, 0.01, 1.0 / 3}) {
      for (const double height : {1e-3, 1e-6, 1e-9}) {
        CAPTURE(surrounded);
        CAPTURE(foot);
        CAPTURE(height);
        const Pslg pslg = sliver(foot, height, surrounded);
        const job::Request request = bounded(20, 0, 100'000);
        const Made mesh = made(pslg, request);
        REQUIRE(mesh.record.complete);
        check_mesh(mesh, pslg, request);
        CHECK(listed(mesh.record, kNoRoom) == 0);
        CHECK(static_cast<double>(mesh.record.triangles) < 40 * (2 - std::log2(height)));
      }
    }
}

TEST_CASE("a narrow wedge costs the logarithm of its angle, not its inverse") {
  std::int64_t before = 0;
  for (const double angle : {1e-3, 1e-5, 1e-7}) {
    Pslg pslg;
    pslg.points = {{0, 0}, {0.8, 0}, {0.5 * std::cos(angle), 0.5 * std::sin(angle)}, {-1, -1}, {1, -1},
                   {1, 1}, {-1, 1}};
    pslg.segments = {{0, 1, 1}, {0, 2, 2}, {3, 4, 0}, {4, 5, 0}, {5, 6, 0}, {6, 3, 0}};
    const job::Request request = bounded(20);
    const Made mesh = made(pslg, request);
    check_mesh(mesh, pslg, request);
    CHECK(listed(mesh.record, kNoRoom) == 0);
    CHECK(mesh.record.triangles < 500);
    CHECK(mesh.record.triangles > before);
    before = mesh.record.triangles;
  }
}

TEST_CASE("region bounds hold, even where regions touch") {
  Pslg pslg = rectangle(2, 1);
  pslg.points.push_back({1, 0});
  pslg.points.push_back({1, 1});
  pslg.segments = {{0, 4, 1}, {4, 1, 1}, {1, 2, 2}, {2, 5, 3}, {5, 3, 3}, {3, 0, 4}, {4, 5, 9}};
  pslg.regions = {{{0.5, 0.5}, 1, 1e-3}, {{1.5, 0.5}, 2, 1e-2}};
  job::Request request = bounded(20);
  const Made mesh = made(pslg, request);
  check_mesh(mesh, pslg, request);
  CHECK(listed(mesh.record, kLarge) == 0);
  std::size_t fine = 0, coarse = 0;
  for (const double region : mesh.mesh.regions) (region == 1 ? fine : coarse) += 1;
  CHECK(fine > 5 * coarse);
  request.bounds.region_areas = false;
  CHECK(made(pslg, request).mesh.triangles.size() < 50);
}

TEST_CASE("a limit on triangles stops refinement with a valid mesh") {
  const Made mesh = made(rectangle(1, 1), bounded(20, 1e-6, 5000));
  CHECK(!mesh.record.complete);
  CHECK(mesh.record.triangles >= 5000);
  CHECK(mesh.record.triangles < 5100);
  check_mesh(mesh, rectangle(1, 1), bounded(0));
}

TEST_CASE("a piece has the input's points first and every subsegment once") {
  const Pslg pslg = rectangle(2, 1);
  const auto& [piece, record, uncut] = made(pslg, bounded(20, 0.01));
  for (std::size_t i = 0; i < 4; ++i) CHECK(piece.points[i] == pslg.points[i]);
  CHECK(static_cast<std::int64_t>(piece.triangles.size()) == record.triangles);
  CHECK(static_cast<std::int64_t>(piece.points.size()) == record.vertices);
  double by_marker[5] = {};
  for (const Mesh::Edge& e : piece.edges)
    by_marker[e.marker] += std::sqrt(squared_distance(piece.points[e.a], piece.points[e.b]));
  CHECK(by_marker[1] == doctest::Approx(2));
  CHECK(by_marker[2] == doctest::Approx(1));
  CHECK(by_marker[3] == doctest::Approx(2));
  CHECK(by_marker[4] == doctest::Approx(1));
}

TEST_CASE("requests out of range are rejected") {
  CHECK_THROWS_AS(made(rectangle(1, 1), bounded(35)), Error);
  CHECK_THROWS_AS(made(rectangle(1, 1), bounded(-1)), Error);
}
