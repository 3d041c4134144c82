#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "adapt/fields.hpp"
#include "adapt/locator.hpp"
#include "cases.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/mesher.hpp"
#include "geometry/triangle_geometry.hpp"
#include "patch/part.hpp"
#include "patch/remake.hpp"
#include "support/mesh_equality.hpp"
#include "support/random.hpp"
#include "support/random_domain.hpp"
#include "verify/report_text.hpp"
#include "verify/verify.hpp"

// Random meshes that are all made anew, in one piece and in subdomains: what they keep of the mesh that they replace,
// by sums over both that nothing of the product is asked for.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

CornerPoints corners_of(const Mesh& mesh, std::size_t t) {
  const auto at = [&](std::size_t i) { return mesh.points[static_cast<std::size_t>(mesh.triangles[t][i])]; };
  return {at(0), at(1), at(2)};
}

double area_at(const Mesh& mesh, std::size_t t) {
  const auto [a, b, c] = corners_of(mesh, t);
  return ((b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y)) / 2;
}

std::map<double, double> areas_by_region(const Mesh& mesh) {
  std::map<double, double> areas;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    areas[mesh.regions.empty() ? 0 : mesh.regions[t]] += area_at(mesh, t);
  return areas;
}

std::map<std::int32_t, double> lengths_by_marker(const Mesh& mesh) {
  std::map<std::int32_t, double> lengths;
  for (const Mesh::Edge& edge : mesh.edges) {
    const Point &a = mesh.points[static_cast<std::size_t>(edge.a)], &b = mesh.points[static_cast<std::size_t>(edge.b)];
    lengths[edge.marker] += std::hypot(b.x - a.x, b.y - a.y);
  }
  return lengths;
}

double integral(const Mesh& mesh, const std::vector<double>& at_points) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    double values = 0;
    for (const std::int32_t v : mesh.triangles[t]) values += at_points[static_cast<std::size_t>(v)];
    sum += area_at(mesh, t) * values / 3;
  }
  return sum;
}

template <class Key>
void check_same_sums(const std::map<Key, double>& actual, const std::map<Key, double>& expected) {
  REQUIRE(actual.size() == expected.size());
  for (const auto& [key, sum] : expected) {
    CAPTURE(key);
    REQUIRE(actual.contains(key));
    CHECK(actual.at(key) == doctest::Approx(sum).epsilon(1e-9));
  }
}

adapt::Field at_points(const Mesh& mesh, Transfer how, double bend) {
  adapt::Field field{.how = how, .values = {}};
  for (const Point& p : mesh.points) field.values.push_back(1 + 0.3 * p.x - 0.2 * p.y + bend * std::sin(5 * p.x));
  return field;
}

std::optional<Mesh> random_mesh(std::uint64_t seed, double area) {
  try {
    return mesh(random_domain(seed), {.min_angle = 20, .max_area = area});
  } catch (const Error&) {  // encloses nothing
    return {};
  }
}

struct MadeAnew {
  patch::Remade whole;
  std::vector<double> linear, conserved;
};

MadeAnew made_anew(const Mesh& before, const std::vector<double>& lengths, std::int32_t threads, double cut_from) {
  patch::Order order;
  order.inside.assign(before.triangles.size(), true);
  order.lengths = lengths;
  order.threads = threads;
  order.cut_from = cut_from;
  MadeAnew made{.whole = patch::remake(
                    before, {at_points(before, Transfer::kInterpolate, 0), at_points(before, Transfer::kConserve, 0.5)},
                    std::move(order)),
                .linear = {},
                .conserved = {}};
  made.linear = made.whole.fields[0].values;
  made.conserved = made.whole.fields[1].values;
  return made;
}

void check_made_anew(const MadeAnew& made, const Mesh& before) {
  const Mesh& mesh = made.whole.mesh;
  const VerifyOptions options{.min_angle = 20};
  const VerifyReport report = verify(mesh, options);
  CHECK_MESSAGE(report.accepted(), verdict_text(report, options));
  check_same_sums(areas_by_region(mesh), areas_by_region(before));
  check_same_sums(lengths_by_marker(mesh), lengths_by_marker(before));
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    CHECK(made.linear[v] == doctest::Approx(1 + 0.3 * mesh.points[v].x - 0.2 * mesh.points[v].y).epsilon(1e-9));
  const std::vector<double> old = at_points(before, Transfer::kConserve, 0.5).values;
  CHECK(integral(mesh, made.conserved) == doctest::Approx(integral(before, old)).epsilon(1e-11));
  std::set<std::int32_t> stayed;
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    if (const std::int32_t from = made.whole.old_points[v]; from >= 0) {
      CHECK(stayed.insert(from).second);
      CHECK(before.points[static_cast<std::size_t>(from)] == mesh.points[v]);
    }
}

}  // namespace

TEST_CASE("meshes that are all made anew have the areas, lines and integrals that they had") {
  auto random = seeded_generator("remake_property_test");
  constexpr double kAlways = -std::numeric_limits<double>::infinity();
  constexpr std::int64_t kCases = 60;
  int cut = 0;
  for (std::int64_t tried = 0; more_cases(tried, kCases, cut > 5); ++tried) {
    const std::uint64_t seed = random();
    CAPTURE(seed);
    const std::optional<Mesh> before = random_mesh(seed, uniform(random, 0.002, 0.02));
    if (!before) continue;
    const double least = uniform(random, 0.03, 0.1), x = uniform(random, -1, 1), y = uniform(random, -1, 1);
    std::vector<double> lengths;
    for (const Point& p : before->points) lengths.push_back(least + 0.15 * std::hypot(p.x - x, p.y - y));
    const MadeAnew one = made_anew(*before, lengths, 1, kAlways);
    check_made_anew(one, *before);
    cut += one.whole.mesh.subdomains.empty() ? 0 : 1;
    const MadeAnew three = made_anew(*before, lengths, 3, kAlways);
    test::check_same_mesh(three.whole.mesh, one.whole.mesh);
    CHECK(three.linear == one.linear);
    CHECK(three.conserved == one.conserved);
    CHECK(three.whole.old_points == one.whole.old_points);
    CHECK(three.whole.old_triangles == one.whole.old_triangles);
    check_made_anew(made_anew(*before, lengths, 2, kWorthCutting), *before);
  }
}

TEST_CASE("points of one mesh of a domain are in the other one where a look at all triangles finds them") {
  auto random = seeded_generator("remake_property_test");
  for (std::int64_t tried = 0; more_cases(tried, 40, true); ++tried) {
    const std::uint64_t seed = random();
    CAPTURE(seed);
    const std::optional<Mesh> coarse = random_mesh(seed, 0.02), fine = random_mesh(seed, 0.003);
    if (!coarse || !fine) continue;
    const Triangulation before = patch::link(*coarse).triangulation;
    const adapt::Locator locator(before);
    for (const Point& p : fine->points) {
      const adapt::Locator::Place place = locator.locate(p);
      Point at{0, 0};
      for (int i = 0; i < 3; ++i) {
        at.x += place.weight[i] * before.corner(place.triangle, i).x;
        at.y += place.weight[i] * before.corner(place.triangle, i).y;
      }
      CHECK(std::hypot(at.x - p.x, at.y - p.y) < 1e-9);
      CHECK(!place.beyond);
    }
  }
}
