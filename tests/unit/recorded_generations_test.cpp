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
    0x332598bc55658522, 0x8445a912c54e98f0, 0xb9a0879a07ab9a2d, 0x0efafb2392de57a5, 0xc12b132fc507364d,
    0x8f05b5ae0489e0ae, 0x5cfde55ff2965b40, 0x8456d9adb8c90ec2, 0x877ecaf60172bcf4, 0xb248b327b6c5c465,
    0xa2c33088a705b82e, 0xea38dde96e0ac938, 0x474f6d7e033db391, 0x7700b0f0b4c42e6a, 0x6e23fee96069456f,
    0x4c8c1b0d3eafd9dc, 0xcfa2a1d1e606e7d4, 0xce760a37af105b0f, 0x343293948a6d162c, 0xec81249da66f0899,
    0x55c07958085b35b0, 0xb2d3f47982edf322, 0x20597f9a5f111ba2, 0xdd2e319d0a5a585a, 0xfefda9a3883e1d11,
    0xd671b5261802b40b, 0x21532435090abe5a, 0xdca0aff6194ed5f6, 0x3e76e181edf16c81, 0x14f18f9d0b8a8077,
    0xe4a2ea7920132180, 0xc5a49228d71b18da};

}  // namespace

TEST_CASE("generations are those that were recorded") {
  AdaptReport sums;
  check_recorded(kRecordedGenerations, [&](std::uint64_t seed) { return digest_of_session(seed, sums); });
  CHECK(sums.kept > 10);
  CHECK(sums.mended > 100);
  CHECK(sums.divided > 5);
  CHECK(sums.joined > 10);
}
