#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <set>

#include "driftmesh/error.hpp"
#include "driftmesh/repair.hpp"
#include "job/domain.hpp"
#include "property/cases.hpp"
#include "sizing/across.hpp"
#include "support/made_mesh.hpp"
#include "support/random_channels.hpp"
#include "verify/verify.hpp"

// Meshes of random channels have the layers of triangles across them that are asked for, and the check of that counts
// as the eye does.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

/// A strip of `layers` rows of squares, each cut in two.
Mesh rows(int layers, double height) {
  constexpr int kColumns = 12;
  Mesh mesh;
  for (int j = 0; j <= layers; ++j)
    for (int i = 0; i <= kColumns; ++i) mesh.points.push_back({i * 1.0, j * height / layers});
  for (int j = 0; j < layers; ++j)
    for (int i = 0; i < kColumns; ++i) {
      const int a = j * (kColumns + 1) + i, b = a + 1, c = a + kColumns + 1, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  return mesh;
}

AcrossReport counted(const Mesh& mesh, const AcrossRule& rule, Findings& findings) {
  return check_across(mesh, {}, rule, findings);
}

/// By a flood over edges: the fewest edges between points of the mesh with y = 0 and x in a range, and others with y =
/// `height`.
int fewest_edges(const Mesh& mesh, double height, double from, double to) {
  std::map<std::int32_t, std::set<std::int32_t>> neighbors;
  for (const auto& [a, b, c] : mesh.triangles)
    for (const auto& [u, v] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
      neighbors[u].insert(v);
      neighbors[v].insert(u);
    }
  std::set<std::int32_t> reached, edge;
  for (const auto& [v, around] : neighbors)
    if (mesh.points[v].y == 0 && from <= mesh.points[v].x && mesh.points[v].x <= to) edge.insert(v);
  for (int steps = 0; !edge.empty(); ++steps) {
    std::set<std::int32_t> next;
    for (const std::int32_t v : edge) {
      if (mesh.points[v].y == height) return steps;
      reached.insert(v);
      for (const std::int32_t w : neighbors[v])
        if (!reached.contains(w)) next.insert(w);
    }
    edge = next;
  }
  return -1;
}

}  // namespace

TEST_CASE("layers of a strip are counted") {
  for (int layers = 1; layers <= 6; ++layers)
    for (int asked = 1; asked <= 7; ++asked) {
      const Mesh mesh = rows(layers, 2.5);
      Findings findings;
      const AcrossReport found = counted(mesh, {asked, 0}, findings);
      CHECK(found.crossings > 10);
      CHECK(found.fewest == std::min(layers, asked));
      CHECK(findings.count(Flaw::kFewAcross) == (layers < asked ? found.crossings : 0));
      CHECK((layers == 1) == (found.on_boundary == mesh.triangles.size()));
      Findings none;
      const AcrossReport excused = counted(mesh, {asked, 2.6}, none);
      CHECK(none.empty());
      CHECK(excused.crossings == 0);
      CHECK(excused.too_narrow == found.crossings);
    }
}

TEST_CASE("nothing is asked of corners and wide places") {
  Findings findings;
  Mesh mesh;  // a triangle, and a star of triangles around a point
  mesh.points = {{0, 0}, {1, 0}, {0, 1}};
  mesh.triangles = {{0, 1, 2}};
  CHECK(counted(mesh, {3, 0}, findings).crossings == 0);
  mesh.points = {{0, 0}};
  mesh.triangles.clear();
  for (int i = 0; i < 5; ++i) mesh.points.push_back({std::cos(i * 1.2566), std::sin(i * 1.2566)});
  for (int i = 0; i < 5; ++i) mesh.triangles.push_back({0, i + 1, (i + 1) % 5 + 1});
  CHECK(counted(mesh, {3, 0}, findings).fewest >= 2);
}

TEST_CASE("sides that meet in a point where the outline touches itself are no channel") {
  Pslg corner;  // a triangle, to which another one is added in a point
  corner.points = {{5, 0}, {0, 4}, {0, 0}};
  corner.segments = {{0, 1, 1}, {1, 2, 1}, {2, 0, 1}};
  Pslg touching = corner;
  touching.points.insert(touching.points.end(), {{10, 3}, {10, 1}});
  touching.segments.insert(touching.segments.end(), {{0, 3, 1}, {3, 4, 1}, {4, 0, 1}});
  for (const Pslg& pslg : {corner, touching}) {
    job::Request request = bounded(20, 0, 300'000);
    request.sizing.across = 2;
    Findings findings;
    counted(made(pslg, request).mesh, {2, 0}, findings);
    CHECK(findings.empty());
  }
}

TEST_CASE("channels have the layers that are asked for") {
  Random random = seeded_generator("layers across channels");
  std::int64_t crossings = 0, meshes = 0;
  for (std::int64_t c = 0; c < case_count(60); ++c) {
    CAPTURE(c);
    const Pslg pslg = random_channel(random);
    job::Request request = bounded(20, 0, 300'000);
    request.sizing.across = static_cast<std::int32_t>(2 + random() % 4);
    request.limits.keep_incomplete = false;
    request.decomposition.subdomains = random() % 4 == 0 ? 4 : 1;
    if (random() % 3 == 0) request.sizing.shortest = uniform(random, 0.05, 0.3);
    CAPTURE(request.sizing.across);
    Pslg domain = pslg;
    try {
      repair(domain);
      const Made found = made(pslg, request);
      const VerifyReport report =
          verify(found.mesh, domain,
                 {.min_angle = 20,
                  .across = {request.sizing.across, width_for(request.sizing.shortest, request.sizing.across)}});
      for (const std::string& message : report.findings.messages(Flaw::kFewAcross)) MESSAGE(message);
      CHECK(report.findings.count(Flaw::kFewAcross) == 0);
      CHECK(report.accepted());
      crossings += static_cast<std::int64_t>(report.across.crossings);
      ++meshes;
      // Creeks are listed where the check has to excuse crossings, and nowhere else but near the limit.
      if (report.across.too_narrow > 0) CHECK(!found.record.creeks.empty());
      for (const Creek& creek : found.record.creeks)
        CHECK(creek.width < width_for(request.sizing.shortest, request.sizing.across));
    } catch (const Error&) {  // banks that cross may enclose nothing, or come too close to each other
    }
  }
  CHECK(meshes > case_count(60) / 2);
  CHECK(crossings > 20 * meshes);
}

TEST_CASE("a strip between straight banks has no shorter way across than asked for") {
  Random random = seeded_generator("ways across");
  for (std::int64_t c = 0; c < case_count(20); ++c) {
    CAPTURE(c);
    const double height = uniform(random, 0.5, 2), length = height * uniform(random, 6, 20);
    Pslg strip;
    add_ring(strip, {{0, 0}, {length, 0}, {length, height}, {0, height}}, 1);
    job::Request request = bounded(20);
    request.sizing.across = static_cast<std::int32_t>(2 + random() % 4);
    const Mesh mesh = made(strip, request).mesh;
    CHECK(fewest_edges(mesh, height, 1.5 * height, length - 1.5 * height) >= request.sizing.across);
  }
}
