#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "driftmesh/driftmesh.hpp"
#include "support/random_domain.hpp"
#include "support/recorded.hpp"
#include "support/value_digest.hpp"

// Parts of finished meshes made anew, and other outlines of them, to the last bit: points, triangles, edges, labels,
// data and old numbers. That these meshes are right is for tests/cli/adapt_test.py.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

Pslg domain_of_part(std::uint64_t seed, double pier) {
  if (seed % 3 == 0) return random_domain(seed, 2);
  Pslg pslg;
  const double x = 2 + 0.25 * static_cast<double>(seed % 4);
  pslg.points = {{0, 0}, {4, 0},   {4, 2},     {x + pier, 2}, {x, 2 - pier}, {1, 2},
                 {0, 2}, {1, 0.5}, {1.5, 0.5}, {1.5, 1},      {3, 0.5},      {3.5, 1}};
  pslg.segments = {{0, 1, 1}, {1, 2, 2}, {2, 3, 3}, {3, 4, 4}, {4, 5, 3},  {5, 6, 3},
                   {6, 0, 5}, {7, 8, 6}, {8, 9, 6}, {9, 7, 6}, {10, 11, 7}};
  if (seed % 2 == 0) pslg.holes = {{1.4, 0.6}};
  if (seed % 2 == 1) pslg.regions = {{{1.4, 0.6}, 4, 0}, {{0.1, 0.1}, 5, 0}};
  pslg.names.markers = {{1, "sea"}, {3, "quay"}};
  return pslg;
}

void add(ValueDigest& digest, const AdaptedMesh& made) {
  const Mesh& mesh = made.mesh;
  for (const Point& p : mesh.points) digest.add(p.x), digest.add(p.y);
  for (const auto& corners : mesh.triangles) digest.add(corners);
  for (const Mesh::Edge& edge : mesh.edges) digest.add(std::array{edge.a, edge.b, edge.marker});
  digest.add(mesh.point_markers);
  for (const double value : mesh.attributes) digest.add(value);
  for (const double region : mesh.regions) digest.add(region);
  for (const Mesh::Weir& weir : mesh.weirs) digest.add(weir.points);
  for (const auto& [marker, name] : mesh.names.markers) digest.add(std::int64_t{marker});
  digest.add(made.old_points);
  digest.add(made.old_triangles);
  for (const std::int64_t count : {made.margin, made.beyond}) digest.add(count);
  digest.add(made.margin_width);
}

std::uint64_t digest_of_part(std::uint64_t seed, std::int64_t& made_anew) {
  constexpr std::array<double, 4> kAngles{20, 0, 28, 15};
  Mesh before = mesh(domain_of_part(seed, 0.2), {.min_angle = 20, .max_area = 0.02});
  if (seed % 4 != 3) {  // data, of which some is conserved
    before.attributes_per_point = 2;
    before.attribute_names = {"depth", "heat"};
    before.attributes.clear();
    for (const Point& p : before.points) before.attributes.insert(before.attributes.end(), {std::sin(3 * p.x), p.y});
    before.point_markers.clear();
    for (std::size_t v = 0; v < before.points.size(); ++v)
      before.point_markers.push_back(static_cast<std::int32_t>(v % 3));
  }
  PartOptions options;
  options.min_angle = kAngles[seed % kAngles.size()];
  if (seed % 4 == 1) options.conserve = {"heat"};
  if (seed % 5 == 0) options.sizes.longest = 0.1;
  if (seed % 5 == 1) options.sizes.shortest = 0.4;
  if (seed % 5 == 2)
    for (const Point& p : before.points) options.lengths.push_back(0.05 + 0.2 * std::abs(p.x - 1.5));
  if (seed % 7 == 0) options.sizes.gradation = 0;
  ValueDigest digest;
  const auto note = [&](const AdaptedMesh& made) {
    add(digest, made);
    for (const std::int32_t old : made.old_triangles) made_anew += old < 0;
  };
  try {
    if (seed % 3 == 0 || seed % 4 != 0) {
      std::vector<std::int32_t> part;
      for (std::size_t t = 0; t < before.triangles.size(); ++t) {
        const Point& p = before.points[static_cast<std::size_t>(before.triangles[t][0])];
        if (std::abs(p.x - 1.5) < 0.8 && (seed % 2 == 0 || p.y > 0.7)) part.push_back(static_cast<std::int32_t>(t));
      }
      note(adapt_part(before, part, options));
    }
    if (seed % 3 != 0) {
      options.conserve.clear();
      if (seed % 6 == 1) options.tolerance = 0.01;
      note(adapt_outline(before, domain_of_part(seed, 0.35), options));
      note(adapt_outline(before, domain_of_part(seed, 0.2 + 1e-3), options));
    }
  } catch (const Error& error) {
    digest.add(std::string_view(error.what()));
  }
  return digest.value();
}

constexpr std::array<std::uint64_t, 84> kRecordedParts{
    0xb2a86fcf4db888f0, 0x2254d955bb6e59ae, 0x0821fc263d806818, 0x83a1c8bd4eecc2ab, 0xb28816ee87265b06,
    0x059fd0c2301bee1d, 0x441cd51ffb4fe305, 0x83a1c8bd4eecc2ab, 0x11dd124bbb8c7386, 0x16ca51242d38da87,
    0x5d7f7a24ffa6dfba, 0x452cf6c3089cb1a9, 0x9a842d3c9df09223, 0x62ed92d7aa9e43ef, 0xd6c09771a775f598,
    0x51f9243f2caeebdb, 0x713fd8b3652a9523, 0xf34c5ec7d165c7cd, 0xefef4265e026ee44, 0xea7be9244e3ba86d,
    0xfba227e6df6f01fc, 0x2254d955bb6e59ae, 0x99f7e35e2de10fc3, 0xd5b0384b30544d9b, 0xea32b7d9c8081756,
    0xf57fec74a8adeb31, 0x7687e018a0ea4b29, 0x83a1c8bd4eecc2ab, 0x9dca6f6fed09c73a, 0x08dc5636bedc8ad9,
    0x57c16afdac9537e8, 0x391331cb7627f851, 0x87a8d3534f83ffe8, 0x62ed92d7aa9e43ef, 0xa09dd6578729948e,
    0x5041ef6b4b646a08, 0xaddeb50672a51f7d, 0x62ed92d7aa9e43ef, 0xf3e91ad0a48f1f48, 0xea7be9244e3ba86d,
    0x65efbe8171086676, 0xc925aa26d3b71642, 0xefef4265e026ee44, 0x83a1c8bd4eecc2ab, 0x7c71f142e2bd58d0,
    0xf57fec74a8adeb31, 0x773e67bff69a4610, 0x64932d7cc7a38236, 0x9a842d3c9df09223, 0x16ca51242d38da87,
    0x598dc4a9bcfbf5db, 0x391331cb7627f851, 0x9dca6f6fed09c73a, 0x6cd7e61fc8c90b21, 0x74bd831e12bd07bb,
    0x51f9243f2caeebdb, 0xe5cc3d6181073611, 0x62ed92d7aa9e43ef, 0x99f7e35e2de10fc3, 0x81f3c5d78b24b736,
    0xb2a86fcf4db888f0, 0x2254d955bb6e59ae, 0xbd78f52ef8d64fa1, 0x83a1c8bd4eecc2ab, 0xb28816ee87265b06,
    0xd082c8a1250b11ba, 0x441cd51ffb4fe305, 0x83a1c8bd4eecc2ab, 0x39e9acafaf16c971, 0x16ca51242d38da87,
    0x5d7f7a24ffa6dfba, 0x3eb866d7e492a850, 0x9a842d3c9df09223, 0x62ed92d7aa9e43ef, 0x62d5138520fe9b2b,
    0x51f9243f2caeebdb, 0x713fd8b3652a9523, 0x18ddd3f93c4262d2, 0xefef4265e026ee44, 0xea7be9244e3ba86d,
    0xf90279c7e56abb94, 0x2254d955bb6e59ae, 0x99f7e35e2de10fc3, 0x5dccbe4677f63526};

}  // namespace

TEST_CASE("parts made anew are those that were recorded") {
  std::int64_t made_anew = 0;
  check_recorded(kRecordedParts, [&](std::uint64_t seed) { return digest_of_part(seed, made_anew); });
  CHECK(made_anew > 10'000);
}
