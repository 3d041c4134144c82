#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "driftmesh/repair.hpp"
#include "mesh/cdt.hpp"
#include "mesh/to_piece.hpp"
#include "oracles/mesh_oracle.hpp"
#include "oracles/meshing.hpp"
#include "oracles/random_pslg.hpp"
#include "support/made_mesh.hpp"
#include "verify/report_text.hpp"
#include "verify/verify.hpp"

// Meshes of random inputs, checked by the verifier and, if small, by the brute-force oracles. A failure prints its seed
// and the input as a .poly.

using namespace driftmesh;
using namespace driftmesh::oracles;
using testing::bounded;
using testing::made;

namespace {

const std::vector<std::string> kRight;

// Under the address sanitizer everything is several times slower.
#ifdef __SANITIZE_ADDRESS__
constexpr std::uint64_t kFewer = 4;
#else
constexpr std::uint64_t kFewer = 1;
#endif

Point random_point(std::mt19937_64& random, const RandomPslgShape& shape) {
  std::uniform_real_distribution<double> in(-1, 1);
  const double x = in(random), y = in(random);
  return {shape.offset + shape.scale * x, shape.offset + shape.scale * y};
}

job::Request random_request(std::uint64_t seed, const RandomPslgShape& shape) {
  std::mt19937_64 random(seed * 77 + 5);
  const double angles[] = {0, 10, 20, 20.7, 25, 28, 30, 33};
  const double angle = angles[random() % 8];
  const double area = random() % 2 == 0 ? 0 : shape.scale * shape.scale * std::exp2(-static_cast<double>(random() % 9));
  return bounded(angle, area, 200000);
}

}  // namespace

TEST_CASE("triangulations of random inputs pass the brute-force oracles") {
  for (std::uint64_t seed = 1; seed <= 25 / kFewer; ++seed) {
    CAPTURE(seed);
    const RandomPslgShape shape = make_random_shape(seed);
    RandomPslg random = make_random_pslg(seed, shape);
    CAPTURE(poly_text(random.input));
    REQUIRE(!repair(random.input).changed());
    const Mesh mesh = to_piece(triangulate(random.input), random.input);
    const VerifyReport report = verify(mesh, random.input, {});
    INFO(report_text(report, {}));
    CHECK(report.accepted());
    CHECK(check_constrained_delaunay(mesh) == kRight);
    CHECK(check_area(mesh, find_boundary(mesh)) == kRight);
    CHECK(check_coverage(mesh, random.input, 0, std::vector<bool>(random.input.segments.size(), false)) == kRight);
    std::mt19937_64 places(seed + 1000);  // not the points that the input was made from
    for (int i = 0; i < 20; ++i) {
      const Point p = random_point(places, shape);
      CHECK(count_covering(mesh, p) == (inside_by_parity(random.input, random.boundary_segments, p) ? 1 : 0));
    }
  }
}

TEST_CASE("refined meshes of random inputs keep every guarantee") {
  std::size_t triangles = 0, exceptions = 0, meshes_with_holes = 0;
  for (std::uint64_t seed = 1; seed <= 150 / kFewer; ++seed) {
    CAPTURE(seed);
    const RandomPslgShape shape = make_random_shape(seed);
    const RandomPslg random = make_random_pslg(seed, shape);
    const job::Request request = random_request(seed, shape);
    CAPTURE(request.bounds.angle);
    CAPTURE(request.bounds.area);
    CAPTURE(poly_text(random.input));
    const MeshingOutcome outcome = repair_mesh_and_verify(random.input, request);
    CHECK(outcome.failure == "");
    CHECK(outcome.refusal == "");
    CHECK(outcome.complete);
    triangles += outcome.triangles;
    exceptions += outcome.exceptions;
    meshes_with_holes += !random.input.holes.empty();
  }
  MESSAGE(triangles << " triangles, " << exceptions << " exceptions");
  CHECK(triangles > 10000 / kFewer);
  CHECK(exceptions > 10);
  CHECK(meshes_with_holes > 30 / kFewer);
}

TEST_CASE("refined meshes of small random inputs cover their segments, by rational arithmetic") {
  for (std::uint64_t seed = 500; seed < 500 + 15 / kFewer; ++seed) {
    CAPTURE(seed);
    const RandomPslgShape shape = make_random_shape(seed);
    const RandomPslg random = make_random_pslg(seed, shape);
    CAPTURE(poly_text(random.input));
    const Mesh mesh = made(random.input, bounded(20)).mesh;
    const double tolerance = 64 * 0x1p-52 * (std::fabs(shape.offset) + shape.scale);
    CHECK(check_coverage(mesh, random.input, tolerance, std::vector<bool>(random.input.segments.size(), false)) ==
          kRight);
    CHECK(check_area(mesh, find_boundary(mesh)) == kRight);
  }
}

TEST_CASE("arbitrary bytes become inputs that are rejected or meshed correctly") {
  std::size_t meshed = 0, refused = 0;
  for (std::uint64_t seed = 1; seed <= 400 / kFewer; ++seed) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::vector<std::uint8_t> bytes(4 + random() % 60);
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
    const MeshingCase c = case_from_bytes(bytes);
    CAPTURE(c.request.bounds.angle);
    CAPTURE(c.request.bounds.area);
    CAPTURE(poly_text(c.input));
    const MeshingOutcome outcome = repair_mesh_and_verify(c.input, c.request);
    CHECK(outcome.failure == "");
    CHECK((outcome.complete || !c.coarse));
    meshed += outcome.refusal.empty();
    refused += !outcome.refusal.empty();
  }
  MESSAGE(meshed << " meshed, " << refused << " refused");
  CHECK(meshed > 100 / kFewer);
  CHECK(refused > 0);
}

TEST_CASE("mesher and check agree on details of any size, at the origin and elsewhere") {
  constexpr Point kPlaces[] = {{0, 0}, {1, 0}, {0.5, 0.5}, {0, 0.5}};
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> in(0, 1);
  std::size_t exceptions = 0;
  for (std::uint64_t i = 0; i < 400 / kFewer || (exceptions == 0 && i < 400); ++i) {
    // Any size, or a cluster at the limit: what lies within 1e-15 of the square is one point.
    const bool cluster = i / 4 % 2 == 1;
    const double size = std::pow(10, cluster ? -15 + 0.5 * in(random) : -1 - 35 * in(random));
    const Point& place = kPlaces[i % 4];
    Pslg input;
    input.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    input.segments = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 0, 1}, {4, 5, 2}};
    if (cluster) input.segments.push_back({6, 7, 3});
    for (int k = 0; k < (cluster ? 6 : 2); ++k)
      input.points.push_back({place.x + size * (1 + 4 * in(random)), place.y + size * (1 + 4 * in(random))});
    CAPTURE(poly_text(input));
    const MeshingOutcome outcome = repair_mesh_and_verify(input, bounded(20, 0, 200000));
    CHECK(outcome.failure == "");
    CHECK(outcome.complete);
    exceptions += outcome.exceptions;
  }
  CHECK(exceptions > 0);
}
