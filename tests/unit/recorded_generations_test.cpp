#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "driftmesh/adaptive.hpp"
#include "driftmesh/error.hpp"
#include "mesh/digest.hpp"
#include "support/random_domain.hpp"
#include "support/recorded.hpp"
#include "support/value_digest.hpp"
#include "support/varied_domain.hpp"
#include "support/waves.hpp"

// Meshes that follow lengths for some generations, with fields of all kinds, to the last bit: what the session decides
// (what stays, what is mended, cut and joined) shows in the mesh, in fields and in reports. That these meshes are right
// is for adaptive_property_test; that ranks and threads change nothing, too.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

Pslg domain_of_session(std::uint64_t seed) {
  return seed % 4 == 1 ? varied_domain() : random_domain(seed, 2);
}

/// A ring that grows, within which, and far from which, lengths are long.
double length_at(const Point& p, std::uint64_t seed, int generation) {
  const double radius = 0.3 + 0.15 * generation + 0.1 * static_cast<double>(seed % 5);
  const double fine = seed % 3 == 0 ? 0.02 : 0.06;
  return std::min(fine + 0.5 * std::abs(std::hypot(p.x - 0.5, p.y) - radius), seed % 2 == 0 ? 0.5 : 0.25);
}

void add(ValueDigest& digest, AdaptiveMesh& session) {
  const Mesh& mesh = session.mesh();
  digest.add(mesh_digest(mesh));
  for (const Mesh::Edge& edge : mesh.edges)
    for (const std::int32_t value : {edge.a, edge.b, edge.marker}) digest.add(std::int64_t{value});
  digest.add(mesh.subdomains);
  for (const double region : mesh.regions) digest.add(region);
  digest.add(session.stayed_points());
  digest.add(session.stayed_triangles());
  for (const auto& parents : session.parents()) digest.add(parents);
  for (const auto& [name, place] : session.fields())
    for (const double value : session.field(name)) digest.add(value);
  const AdaptReport& report = session.report();
  for (const std::int32_t count : {report.kept, report.mended, report.remade, report.divided, report.joined})
    digest.add(std::int64_t{count});
  digest.add(report.scale);
}

std::uint64_t digest_of_session(std::uint64_t seed, AdaptReport& sums) {
  constexpr std::array<double, 5> kAngles{20, 0, 15, 28, 25};
  MeshOptions options{
      .min_angle = kAngles[seed % kAngles.size()], .triangles = 150 + 50 * static_cast<double>(seed % 7), .threads = 1};
  options.subdomains.count = static_cast<std::int32_t>(1 + seed * 5 % 24);
  AdaptiveOptions adaptive;
  adaptive.gradation = seed % 4 == 0 ? 0.0 : 0.3;
  if (seed % 5 == 0) adaptive.shortest = 0.1;
  if (seed % 6 == 0) adaptive.longest = 0.2;
  if (seed % 7 == 0) adaptive.most_triangles = 900;
  if (seed % 8 == 0) adaptive.coarsening = 0.3;
  ValueDigest digest;
  AdaptiveMesh session(domain_of_session(seed), options, adaptive);
  const std::size_t points = session.mesh().points.size(), triangles = session.mesh().triangles.size();
  session.attach("points", waves(2 * points, 0.3));
  session.attach("conserved points", waves(points, 0.7), FieldPlace::kPoints, Transfer::kConserve);
  session.attach("conserved triangles", waves(2 * triangles, 1.1), FieldPlace::kTriangles, Transfer::kConserve);
  session.attach("conserved corners", waves(3 * triangles, 1.3), FieldPlace::kCorners, Transfer::kConserve);
  for (int generation = 1; generation <= 4; ++generation) {
    if (seed % 3 == 1 && generation % 2 == 0) {
      session.adapt([&](const Point& p) { return length_at(p, seed, generation); });
    } else if (seed % 5 == 2 && generation % 2 == 0) {
      std::vector<double> errors = waves(session.mesh().triangles.size(), 0.2);
      for (double& error : errors) error = 1e-3 * (1.1 + error);
      session.adapt(session.lengths_from_error(errors, 0.02, 1 + static_cast<double>(seed % 2)));
    } else {
      std::vector<double> lengths;
      for (const Point& p : session.mesh().points) lengths.push_back(length_at(p, seed, generation));
      session.adapt(lengths);
    }
    add(digest, session);
    sums.mended += session.report().mended;
    sums.kept += session.report().kept;
    sums.divided += session.report().divided;
    sums.joined += session.report().joined;
  }
  return digest.value();
}

constexpr std::array<std::uint64_t, 32> kRecordedGenerations{
    0x332598bc55658522, 0x6279a18a70743723, 0x84c207e698a05a62, 0xdd9cbcd725af0307, 0xc12b132fc507364d,
    0xd6e287f611ca29d9, 0xf98c336660ae42fb, 0x1a4628183e5476bd, 0x24e67951a01be02a, 0xb248b327b6c5c465,
    0x2eb8afdc2ddeaf6d, 0x08ce599523f091fe, 0x9d9a16925896557c, 0x4c294bd91fce8318, 0xc79b70d455b91576,
    0x4c8c1b0d3eafd9dc, 0xcfa2a1d1e606e7d4, 0x8ed86b3c4e85da48, 0x7ea7b337d01a4a99, 0xec5756cf65e83e9e,
    0x55c07958085b35b0, 0x3b577eddca87ff3b, 0x1609ef83358fd318, 0x865b3d70e7630340, 0xfefda9a3883e1d11,
    0x8ecc39b6d2afd5e6, 0x21532435090abe5a, 0x33809f382b1821b8, 0x494550c0785cb2cf, 0x896b1563a4ab98de,
    0x7d6e10cd330899e5, 0x9f986079fb75dd0e};

}  // namespace

TEST_CASE("generations are those that were recorded") {
  AdaptReport sums;
  check_recorded(kRecordedGenerations, [&](std::uint64_t seed) { return digest_of_session(seed, sums); });
  CHECK(sums.kept > 10);
  CHECK(sums.mended > 100);
  CHECK(sums.divided > 5);
  CHECK(sums.joined > 10);
}
