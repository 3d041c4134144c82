#include "decompose/decompose.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "decompose/check_decomposition.hpp"
#include "decompose/subdomain_mesh.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/generate.hpp"
#include "driftmesh/repair.hpp"
#include "geometry/predicates.hpp"
#include "mesh/cdt.hpp"
#include "mesh/exceptions.hpp"
#include "pslg/poly_file.hpp"
#include "sizing/make_size_field.hpp"
#include "small_domains.hpp"
#include "support/prepared_mesh.hpp"
#include "support/refine_together.hpp"
#include "support/rings.hpp"

using namespace driftmesh;
using driftmesh::testing::add_ring;
using driftmesh::testing::prepared;
using driftmesh::testing::rectangle;

namespace {

std::vector<Point> circle(Point center, double radius, int n) {
  std::vector<Point> points;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n;
    points.push_back({center.x + radius * std::cos(angle), center.y + radius * std::sin(angle)});
  }
  return points;
}

Pslg with_holes() {
  Pslg pslg = rectangle(3, 2);
  for (const Point center : {Point{0.6, 0.6}, Point{1.5, 1.3}, Point{2.4, 0.7}}) {
    add_ring(pslg, circle(center, 0.3, 24), 2);
    pslg.holes.push_back(center);
  }
  return pslg;
}

double area_of(const Triangulation& mesh) {
  return summarize_angles(mesh).total_area;
}

Decomposition decompose_into(const Triangulation& mesh, int n) {
  DecomposeOptions options;
  options.subdomains = n;
  return decompose(mesh, options);
}

std::string first_problem(const DecompositionReport& report) {
  return report.valid() ? "" : report.problems[0];
}

/// Checks the invariants, the area, and that every subdomain has a triangulation of its area.
DecompositionReport check_whole(const Decomposition& d, const Triangulation& mesh, std::size_t n) {
  CHECK(d.size() == n);
  const DecompositionReport report = check_decomposition(d);
  CHECK(first_problem(report) == "");
  CHECK(report.area == doctest::Approx(area_of(mesh)).epsilon(1e-12));
  for (const SubdomainId i : ids_of(d.subdomains)) {
    const SubdomainMesh part = subdomain_triangulation(d, i);
    REQUIRE(area_of(part.mesh) == doctest::Approx(d.subdomains[i].area).epsilon(1e-9));
    for (const RootId r : ids_of(part.roots)) {
      const Decomposition::Root& root = d.roots[part.roots[r]];
      const RootSegment& local = part.mesh.roots[r];
      REQUIRE(local.marker == root.marker);
      REQUIRE(local.shell == root.shell);
      REQUIRE(part.mesh.points[local.vertex[0]] == d.points[root.a]);
      REQUIRE(part.mesh.points[local.vertex[1]] == d.points[root.b]);
    }
  }
  return report;
}

}  // namespace

TEST_CASE("one subdomain is the domain: no separators, no new points") {
  const Triangulation mesh = prepared(with_holes());
  const Decomposition d = decompose_into(mesh, 1);
  const DecompositionReport report = check_whole(d, mesh, 1);
  CHECK(d.points.size() == mesh.points.size());
  CHECK(d.roots.size() == mesh.roots.size());
  CHECK(report.separator_length == 0);
  CHECK(report.smallest_angle == 180);
}

TEST_CASE("a square is cut into squares or nearly so") {
  const Triangulation mesh = prepared(rectangle(1, 1));
  for (const int n : {2, 4, 16, 64, 400}) {
    CAPTURE(n);
    const DecompositionReport report = check_whole(decompose_into(mesh, n), mesh, static_cast<std::size_t>(n));
    CHECK(report.smallest_angle >= 60 - 1e-9);
    CHECK(report.largest_load <= 1.3);
    if (n >= 16) CHECK(report.separator_length <= 1.05 * (2.06 * std::sqrt(n) - 2));
  }
}

TEST_CASE("holes: any number of subdomains works and keeps the angle") {
  const Triangulation mesh = prepared(with_holes());
  for (int n = 1; n <= 60; ++n) {
    CAPTURE(n);
    const DecompositionReport report = check_whole(decompose_into(mesh, n), mesh, static_cast<std::size_t>(n));
    CHECK(report.smallest_angle >= 60 - 1e-9);
    if (n >= 20) CHECK(report.largest_load <= 1.45);
  }
}

TEST_CASE("a few heavy pieces are divided, and light ones are joined") {
  const Triangulation mesh = prepared(generate_comb({}));
  for (const int n : {11, 29}) {  // the first cuts leave 1.61 and 1.46 times the mean, and so do groups of finer cuts
    CAPTURE(n);
    CHECK(check_whole(decompose_into(mesh, n), mesh, static_cast<std::size_t>(n)).largest_load <
          (n == 11 ? 1.5 : 1.45));
  }
}

TEST_CASE("a heavy triangle with equal sides is cut in three") {  // no straight cut is fair, at more than 60 degrees
  DecomposeOptions options;
  options.subdomains = 2000;
  options.min_angle = 61.2;
  const Triangulation mesh = prepared(generate_pipe({}));
  const Decomposition d = decompose(mesh, options);
  const DecompositionReport report = check_whole(d, mesh, 2000);
  CHECK(report.smallest_angle >= 61.2 - 1e-9);
  CHECK(report.largest_load <= 1.25);
  CHECK(static_cast<double>(interfaces(d).size()) < 2.1 * 2000);  // 2.5 in groups of smaller pieces
}

TEST_CASE("the same input gives the same decomposition") {
  const Triangulation mesh = prepared(with_holes());
  CHECK(decompose_into(mesh, 77) == decompose_into(mesh, 77));
}

TEST_CASE("disconnected parts get subdomains of their own, or share one if there are fewer") {
  Pslg pslg = rectangle(1, 1);
  add_ring(pslg, {{2, 0}, {4, 0}, {4, 2}, {2, 2}});
  add_ring(pslg, {{2.5, 0.5}, {3.5, 0.5}, {3.5, 1.5}, {2.5, 1.5}});
  add_ring(pslg, {{2.9, 0.9}, {3.1, 0.9}, {3.1, 1.1}, {2.9, 1.1}});
  pslg.holes = {{2.6, 0.6}};
  const Triangulation mesh = prepared(pslg);
  for (const int n : {1, 2, 3, 4, 10, 50}) check_whole(decompose_into(mesh, n), mesh, static_cast<std::size_t>(n));
}

TEST_CASE("inner segments become borders or stay inside, and keep markers and regions") {
  Pslg pslg = rectangle(4, 2);
  add_ring(pslg, circle({1, 1}, 0.6, 20), 5);
  add_ring(pslg, circle({3, 1}, 0.1, 8), 6);
  pslg.points.push_back({2, 0.5});
  pslg.points.push_back({2.2, 1.5});
  pslg.segments.push_back({32, 33, 7});
  pslg.points.push_back({2.6, 1.7});  // isolated
  pslg.regions = {{{0.1, 0.1}, 1, 0}, {{1, 1}, 2, 0}, {{3, 1}, 3, 0}};
  const Triangulation mesh = prepared(pslg);
  for (const int n : {1, 2, 3, 5, 8, 20, 100}) {
    CAPTURE(n);
    const Decomposition d = decompose_into(mesh, n);
    check_whole(d, mesh, static_cast<std::size_t>(n));
    double by_marker[8] = {}, area_by_region[4] = {};
    for (const auto& r : d.roots)
      by_marker[r.marker] += std::hypot(d.points[r.a].x - d.points[r.b].x, d.points[r.a].y - d.points[r.b].y);
    CHECK(by_marker[5] == doctest::Approx(40 * 0.6 * std::sin(std::numbers::pi / 20)));
    CHECK(by_marker[6] == doctest::Approx(16 * 0.1 * std::sin(std::numbers::pi / 8)));
    CHECK(by_marker[7] == doctest::Approx(std::hypot(0.2, 1)));
    std::size_t isolated = 0;
    for (std::size_t i = 0; i < d.size(); ++i) {
      const SubdomainMesh part = subdomain_triangulation(d, static_cast<SubdomainId>(i));
      isolated +=
          static_cast<std::size_t>(std::count(part.mesh.points.begin(), part.mesh.points.end(), Point{2.6, 1.7}));
      for (const TriangleId t : ids_of(part.mesh.triangles))
        area_by_region[part.mesh.region[t]] +=
            0.5 * orient2d(part.mesh.corner(t, 0), part.mesh.corner(t, 1), part.mesh.corner(t, 2));
    }
    CHECK(isolated >= 1);
    CHECK(area_by_region[2] == doctest::Approx(20 * 0.18 * std::sin(std::numbers::pi / 10)));
    CHECK(area_by_region[3] == doctest::Approx(8 * 0.005 * std::sin(std::numbers::pi / 4)));
    CHECK(area_by_region[0] == 0);
  }
}

TEST_CASE("many regions are grouped into few subdomains") {
  Pslg pslg;
  const int n = 12;
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x) {
      pslg.points.push_back({double(x), double(y)});
      const auto v = static_cast<std::int32_t>(pslg.points.size()) - 1;
      if (x > 0) pslg.segments.push_back({v - 1, v, 1});
      if (y > 0) pslg.segments.push_back({v - n - 1, v, 2});
    }
  const Triangulation mesh = prepared(pslg);
  for (const int count : {1, 2, 7, 30, 144, 300}) {
    CAPTURE(count);
    const DecompositionReport report = check_whole(decompose_into(mesh, count), mesh, static_cast<std::size_t>(count));
    CHECK(report.largest_load < (count <= 7 ? 1.2 : 1.7));
  }
}

TEST_CASE("work follows the bounds of regions") {
  Pslg pslg = rectangle(2, 1);
  pslg.points.push_back({1, 0});
  pslg.points.push_back({1, 1});
  pslg.segments = {{0, 4, 1}, {4, 1, 1}, {1, 2, 2}, {2, 5, 3}, {5, 3, 3}, {3, 0, 4}, {4, 5, 9}};
  pslg.regions = {{{0.5, 0.5}, 1, 1e-3}, {{1.5, 0.5}, 2, 1e-2}};
  DecomposeOptions options;
  options.subdomains = 110;
  options.bounds.region_max_area = {0, 1e-3, 1e-2};
  const Decomposition d = decompose(prepared(pslg), options);
  int fine = 0;
  double predicted = 0;
  for (const auto& s : d.subdomains) {
    fine += s.centroid.x < 1;
    predicted += s.predicted;
  }
  CHECK(fine == 100);
  CHECK(predicted == doctest::Approx(1.55 * 1100));
  CHECK(check_decomposition(d).largest_load < 1.4);
}

TEST_CASE("work follows a sizing function, as refinement shows") {
  SizingOptions sizing;
  sizing.expression = "0.004 + 0.05 * sqrt((x - 1)^2 + (y - 1)^2)";
  const auto size = make_size_field(sizing);
  const Triangulation mesh = prepared(with_holes());
  DecomposeOptions options;
  options.subdomains = 40;
  options.bounds.size = size.get();
  const Decomposition d = decompose(mesh, options);
  const DecompositionReport report = check_whole(d, mesh, 40);
  CHECK(report.smallest_angle >= 60 - 1e-9);
  CHECK(report.largest_load <= 1.45);
  double predicted = 0, most = 0, all = 0, largest_area = 0;
  for (const SubdomainId i : ids_of(d.subdomains)) {
    SubdomainMesh part = subdomain_triangulation(d, i);
    Refiner(part.mesh, options.bounds).refine();
    const auto triangles = static_cast<double>(part.mesh.live_triangles());
    most = std::max(most, triangles);
    all += triangles;
    predicted += d.subdomains[i].predicted;
    largest_area = std::max(largest_area, d.subdomains[i].area);
  }
  CHECK(predicted == doctest::Approx(all).epsilon(0.1));
  CHECK(most <= 1.6 * all / 40);
  CHECK(largest_area > 4 * report.area / 40);  // the sizes differ: the field was used
}

TEST_CASE("thin wedges are cut across, and shells stay aligned") {
  for (const double height : {0.02, 0.1, 0.5}) {
    CAPTURE(height);
    Pslg pslg;
    add_ring(pslg, {{0, 0}, {1, 0}, {1, height}});
    const Triangulation mesh = prepared(pslg);
    for (const int n : {2, 10, 100}) {
      CAPTURE(n);
      const Decomposition d = decompose_into(mesh, n);
      const DecompositionReport report = check_whole(d, mesh, static_cast<std::size_t>(n));
      CHECK(report.smallest_angle >= 54);
      CHECK(report.largest_load <= 2);
      QualityBounds bounds;
      bounds.plain.area = report.area / 3000;
      const auto refined = testing::refine_together(d, bounds);
      CHECK(refined.not_conforming.empty());
      for (const SubdomainMesh& part : refined.parts)
        for (const Exceptions::Item& item : find_exceptions(part.mesh, bounds).skinny)
          CHECK((item.cause == ExceptionCause::kInputAngle || item.cause == ExceptionCause::kShell));
    }
  }
}

TEST_CASE("subdomains refined apart conform after exchanging split points") {
  const Triangulation mesh = prepared(with_holes());
  for (const double angle : {20.0, 30.0}) {
    const Decomposition d = decompose_into(mesh, 23);
    QualityBounds bounds;
    bounds.min_angle = angle;
    bounds.plain.area = 1e-3;
    const auto refined = testing::refine_together(d, bounds);
    CHECK(refined.exchanged > 0);
    CHECK(refined.refused == 0);
    CHECK(refined.not_conforming.empty());
    double area = 0;
    for (const SubdomainMesh& part : refined.parts) {
      const Exceptions exceptions = find_exceptions(part.mesh, bounds);
      CHECK(exceptions.skinny.empty());
      CHECK(exceptions.large.empty());
      area += area_of(part.mesh);
    }
    CHECK(area == doctest::Approx(area_of(mesh)).epsilon(1e-12));
  }
}

TEST_CASE("decompositions of real inputs have the documented quality") {
  const std::filesystem::path data = std::filesystem::path(DRIFTMESH_SOURCE_DIR) / ".." / "shared" / "data";
  for (const char* name : {"pipe", "cylinder_flow", "key", "A", "chesapeake"}) {
    const auto file = data / (std::string(name) + ".poly");
    if (!std::filesystem::exists(file)) {
      MESSAGE(file.string() << " is not there: skipped");
      continue;
    }
    CAPTURE(name);
    Pslg pslg = read_poly(file.string());
    repair(pslg, file.string());
    const Triangulation mesh = prepared(pslg);
    for (const int n : {20, 400, 4000}) {
      CAPTURE(n);
      const Decomposition d = decompose_into(mesh, n);
      const DecompositionReport report = check_decomposition(d);
      CHECK(first_problem(report) == "");
      CHECK(report.smallest_angle >= 60 - 1e-9);
      CHECK(report.largest_load <= 1.45);
    }
  }
}

TEST_CASE("a skewed decomposition is uneven, valid and follows its seed") {
  const Triangulation mesh = prepared(with_holes());
  DecomposeOptions options;
  options.subdomains = 100;
  options.skew = 0.8;
  const Decomposition d = decompose(mesh, options);
  const DecompositionReport report = check_whole(d, mesh, 100);
  CHECK(report.smallest_angle >= 60 - 1e-9);
  CHECK(report.largest_load > 2);
  CHECK(d == decompose(mesh, options));
  options.seed = 2;
  CHECK(!(d == decompose(mesh, options)));
}

TEST_CASE("an uneven cut in two gives one side up to twice as much as the other, and is left like that") {
  const Triangulation mesh = prepared(rectangle(2, 1));
  double sum = 0;
  constexpr int kSeeds = 50;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Decomposition d = decompose(mesh, {.subdomains = 2, .bounds = {}, .skew = 1, .seed = seed});
    const double larger = std::max(d.subdomains[SubdomainId{0}].area, d.subdomains[SubdomainId{1}].area) / 2;
    CHECK(larger < 0.7);
    sum += larger;
  }
  // The mean of b / (1 + b) where b is as likely to be any number from 1 to 2.
  CHECK(sum / kSeeds == doctest::Approx(1 - std::log(1.5)).epsilon(0.03));
}

TEST_CASE("options out of range are rejected") {
  const Triangulation mesh = prepared(rectangle(1, 1));
  DecomposeOptions options;
  options.subdomains = 0;
  CHECK_THROWS_AS(decompose(mesh, options), Error);
  options.subdomains = 2;
  options.min_angle = 85;
  CHECK_THROWS_AS(decompose(mesh, options), Error);
  options.min_angle = 60;
  for (const double skew : {-1.0, 1.5}) {
    options.skew = skew;
    CHECK_THROWS_WITH_AS(decompose(mesh, options), doctest::Contains("the skew must be from 0 to 1, not "), Error);
  }
}
