#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "mesh/digest.hpp"
#include "support/made_mesh.hpp"

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

/// A square with a round hole, a slanted inner segment and a few free points.
Pslg domain() {
  Pslg pslg;
  pslg.points = {{-2, -2}, {2, -2}, {2, 2}, {-2, 2}};
  pslg.segments = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 0, 1}};
  for (int i = 0; i < 12; ++i) {
    const double angle = 2 * std::numbers::pi * i / 12;
    pslg.points.push_back({0.7 * std::cos(angle), 0.7 * std::sin(angle)});
    pslg.segments.push_back({4 + i, 4 + (i + 1) % 12, 2});
  }
  pslg.holes = {{0, 0}};
  pslg.points.insert(pslg.points.end(), {{1.2, 0.1}, {1.7, 1.3}, {-1.5, 0.4}, {0.1, 0.05}});  // the last: in the hole
  pslg.segments.push_back({16, 17, 3});
  return pslg;
}

std::array<double, 2> linear_pair(const Point& p) {
  return {3 * p.x - 2 * p.y + 1, -p.x + 0.25 * p.y};
}

Made meshed(const Pslg& pslg) {
  return made(pslg, bounded(20, 0.01));
}

/// The same mesh, numbered differently.
Mesh shuffled(Mesh mesh, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::int32_t> place(mesh.points.size());
  for (std::size_t i = 0; i < place.size(); ++i) place[i] = static_cast<std::int32_t>(i);
  std::shuffle(place.begin(), place.end(), random);
  const std::vector<Point> points = mesh.points;
  for (std::size_t i = 0; i < points.size(); ++i) mesh.points[place[i]] = points[i];
  for (auto& triangle : mesh.triangles) {
    for (std::int32_t& v : triangle) v = place[v];
    std::rotate(triangle.begin(), triangle.begin() + random() % 3, triangle.end());
  }
  std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
  return mesh;
}

}  // namespace

TEST_CASE("Attributes that are linear in the input are so in the mesh") {
  Pslg pslg = domain();
  pslg.attributes_per_point = 2;
  for (const Point& p : pslg.points)
    pslg.attributes.insert(pslg.attributes.end(), {linear_pair(p)[0], linear_pair(p)[1]});
  const Mesh piece = meshed(pslg).mesh;
  REQUIRE(piece.points.size() > 2 * pslg.points.size());
  double error = 0;
  for (std::size_t v = 0; v < piece.points.size(); ++v)
    for (std::size_t k = 0; k < 2; ++k)
      error = std::max(error, std::abs(piece.attributes[2 * v + k] - linear_pair(piece.points[v])[k]));
  CHECK(error < 1e-13);
}

TEST_CASE("Attributes of points on a segment interpolate those of its ends, whatever lies beside it") {
  Pslg pslg = domain();
  pslg.attributes_per_point = 1;
  pslg.attributes.assign(pslg.points.size(), 0);
  pslg.attributes[16] = pslg.attributes[17] = 5;  // the ends of the inner segment
  const Mesh piece = meshed(pslg).mesh;
  int on_segment = 0;
  for (const Mesh::Edge& e : piece.edges)
    if (e.marker == 3) {
      ++on_segment;
      CHECK(piece.attributes[e.a] == doctest::Approx(5).epsilon(1e-12));
      CHECK(piece.attributes[e.b] == doctest::Approx(5).epsilon(1e-12));
    }
  CHECK(on_segment > 2);
  CHECK(*std::max_element(piece.attributes.begin(), piece.attributes.end()) == doctest::Approx(5));
  CHECK(*std::min_element(piece.attributes.begin(), piece.attributes.end()) == 0);
}

TEST_CASE("The digest identifies a mesh by its triangles alone") {
  const auto& [piece, record, uncut] = meshed(domain());
  const std::uint64_t digest = mesh_digest(piece);
  CHECK(record.digest == digest);  // of the triangulation that was refined
  for (unsigned seed = 1; seed <= 5; ++seed) CHECK(mesh_digest(shuffled(piece, seed)) == digest);

  Mesh first = piece, second = piece;  // in two parts
  first.triangles.resize(piece.triangles.size() / 3);
  second.triangles.erase(second.triangles.begin(),
                         second.triangles.begin() + static_cast<std::ptrdiff_t>(first.triangles.size()));
  CHECK(mesh_digest(first) + mesh_digest(second) == digest);
}

TEST_CASE("The digest changes with any bit of a coordinate, a lost triangle, a turned edge or orientation") {
  const Mesh piece = meshed(domain()).mesh;
  const std::uint64_t digest = mesh_digest(piece);
  Mesh moved = piece;
  moved.points[5].y = std::nextafter(moved.points[5].y, 10);
  CHECK(mesh_digest(moved) != digest);
  Mesh less = piece;
  less.triangles.pop_back();
  CHECK(mesh_digest(less) != digest);
  Mesh turned = piece;
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  CHECK(mesh_digest(turned) != digest);
}

TEST_CASE("The digest is the documented function") {
  Mesh piece;
  piece.points = {{1, 0}, {0, 1}, {-0.0, 0}};
  piece.triangles = {{0, 1, 2}};
  CHECK(mesh_digest(piece) == 0xAB8CBA71EE1CDE48U);  // computed by another program from the definition
}

TEST_CASE("Angles fall into the right bins, and the extremes are correct") {
  const auto& [mesh, record, uncut] = meshed(domain());
  const AngleSummary& summary = record.shape;
  std::array<std::int64_t, 18> bins{};
  double smallest = 180, largest = 0;
  for (const auto& triangle : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const Point &apex = mesh.points[triangle[i]], &p = mesh.points[triangle[(i + 1) % 3]],
                  &q = mesh.points[triangle[(i + 2) % 3]];
      const double cross = (p.x - apex.x) * (q.y - apex.y) - (p.y - apex.y) * (q.x - apex.x);
      const double dot = (p.x - apex.x) * (q.x - apex.x) + (p.y - apex.y) * (q.y - apex.y);
      const double degrees = std::atan2(cross, dot) * 180 / std::numbers::pi;
      ++bins[static_cast<std::size_t>(degrees / 10)];
      smallest = std::min(smallest, degrees);
      largest = std::max(largest, degrees);
    }
  CHECK(summary.smallest == doctest::Approx(smallest).epsilon(1e-9));
  CHECK(summary.largest == doctest::Approx(largest).epsilon(1e-9));
  for (std::size_t i = 0; i < bins.size(); ++i) {
    const std::int64_t apart = std::abs(summary.bins[i] - bins[i]);
    CHECK(apart <= (i == 8 || i == 9 ? 8 : 0));  // right angles of the input lie on a limit, and rounding moves them
  }
}
