#include "migration/dormant_mesh.hpp"

#include <doctest/doctest.h>
#include <malloc.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "base/scratch_file.hpp"
#include "base/stopwatch.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/generate.hpp"
#include "driftmesh/mesh.hpp"
#include "driftmesh/repair.hpp"
#include "mesh/digest.hpp"
#include "mesh/link_triangles.hpp"
#include "mesh/refiner.hpp"
#include "mesh/triangulation_fault.hpp"
#include "property/cases.hpp"
#include "pslg/poly_file.hpp"
#include "support/random_subdomains.hpp"
#include "temporary_folder.hpp"

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

using Edge = std::pair<std::pair<double, double>, std::pair<double, double>>;

/// What is allocated, 0 under sanitizers.
std::size_t heap_bytes() {
  const auto heap = mallinfo2();
  return heap.uordblks + heap.hblkhd;
}

std::pair<double, double> pair_of(const Point& p) {
  return {p.x, p.y};
}

/// Every subsegment, leaf or not, by root and path, with its ends, and whether triangles lie on its sides.
std::map<std::pair<GlobalRootId, dyadic::Path>, std::pair<Edge, int>> subsegments_of(const SubdomainMesh& part) {
  std::map<std::pair<GlobalRootId, dyadic::Path>, std::pair<Edge, int>> all;
  const Triangulation& mesh = part.mesh;
  for (const Subsegment& s : mesh.subsegments) {
    const Edge ends{pair_of(mesh.points[s.vertex[0]]), pair_of(mesh.points[s.vertex[1]])};
    const int sides = s.is_leaf() ? (s.half[0] != kNone ? 1 : 0) + (s.half[1] != kNone ? 2 : 0) : -1;
    all[{part.roots[s.root], s.path}] = {ends, sides};
  }
  return all;
}

/// The kind of every vertex, by position: the subsegment of a midpoint by root and path.
std::multiset<std::string> origins_of(const SubdomainMesh& part) {
  std::multiset<std::string> all;
  const Triangulation& mesh = part.mesh;
  for (const VertexId v : ids_of(mesh.points)) {
    if (mesh.origin[v] == kDeleted) continue;
    std::string what = std::to_string(mesh.origin[v]);
    if (is_midpoint(mesh.origin[v])) {
      const Subsegment& s = mesh.subsegments[halved_by(mesh.origin[v])];
      what = "root " + to_string(part.roots[s.root]) + " " + std::to_string(s.path);
    }
    const Point& p = mesh.points[v];
    all.insert(what + " " + std::to_string(std::bit_cast<std::uint64_t>(p.x)) + " " +
               std::to_string(std::bit_cast<std::uint64_t>(p.y)));
  }
  return all;
}

std::array<std::int32_t, 3> in_piece(const std::array<VertexId, 3>& corners) {
  return {to_int(corners[0]), to_int(corners[1]), to_int(corners[2])};
}

/// The digest of the triangles of each region.
std::map<std::uint16_t, std::uint64_t> digests_of(const Triangulation& mesh) {
  std::map<std::uint16_t, Mesh> pieces;
  for (const TriangleId t : ids_of(mesh.triangles))
    if (mesh.triangles[t].alive())
      pieces[mesh.region.empty() ? std::uint16_t{0} : mesh.region[t]].triangles.push_back(
          in_piece(mesh.triangles[t].vertex));
  std::map<std::uint16_t, std::uint64_t> digests;
  for (auto& [region, piece] : pieces) {
    piece.points.assign(mesh.points.begin(), mesh.points.end());
    digests[region] = mesh_digest(piece);
  }
  return digests;
}

/// The digest by the dormant form's own iteration.
std::uint64_t digest_of(const DormantMesh& dormant) {
  Mesh piece;
  piece.points = dormant.points();
  dormant.visit_triangles([&](const auto& corners, std::uint16_t) { piece.triangles.push_back(in_piece(corners)); });
  return mesh_digest(piece);
}

void check_same(const SubdomainMesh& part, const DormantMesh& dormant) {
  const SubdomainMesh woken = dormant.wake();
  REQUIRE(triangulation_fault(woken.mesh) == "");
  CHECK(woken.mesh.triangles.size() == part.mesh.live_triangles());
  CHECK(woken.mesh.points.size() == part.mesh.live_vertices());
  CHECK(digests_of(woken.mesh) == digests_of(part.mesh));
  CHECK(subsegments_of(woken) == subsegments_of(part));
  CHECK(origins_of(woken) == origins_of(part));
  CHECK(woken.roots == part.roots);
  CHECK(woken.points == part.points);
  CHECK(digest_of(dormant) == mesh_digest(part.mesh));
  REQUIRE(woken.mesh.roots.size() == part.mesh.roots.size());
  for (const RootId r : ids_of(part.mesh.roots)) {
    CHECK(woken.mesh.roots[r].marker == part.mesh.roots[r].marker);
    CHECK(woken.mesh.roots[r].shell == part.mesh.roots[r].shell);
  }
  const auto waking = DormantMesh::waking_subsegments(part.mesh);
  for (const SubsegmentId s : ids_of(waking)) {
    const Subsegment &before = part.mesh.subsegments[s], &after = woken.mesh.subsegments[waking[s]];
    REQUIRE((before.root == after.root && before.path == after.path));
  }
}

void check_holds(const SubdomainMesh& part, const DormantMesh& dormant, RandomSubdomains& world) {
  const Triangulation& mesh = part.mesh;
  for (int k = 0; k < 200; ++k) {
    const auto root = static_cast<RootId>(world.random()() % mesh.roots.size());
    const dyadic::Path path = 1 + world.random()() % 63;
    const Subsegment& s = mesh.subsegments[mesh.descend(root, path)];
    CHECK(dormant.holds(root, path) == (s.path == path && !s.is_leaf()));
  }
}

SubdomainMesh refined(const SubdomainContext& context, SubdomainId i) {
  SubdomainMesh part = subdomain_triangulation(*context.decomposition, i);
  Refiner(part.mesh, context.bounds).refine();
  return part;
}

}  // namespace

TEST_CASE("a mesh that slept is the same mesh") {
  auto random = seeded_generator("sleeping meshes");
  std::size_t regions = 0, several_sides = 0;
  for (std::int64_t i = case_count(60); i > 0; --i) {
    const std::uint64_t seed = random() % 100'000;
    CAPTURE(seed);
    RandomSubdomains world(seed, static_cast<int>(1 + seed % 4), 400);
    for (const SubdomainId k : first_ids<SubdomainId>(world.size())) {
      const SubdomainMesh part = refined(world.context(), k);
      const DormantMesh dormant(part);
      check_same(part, dormant);
      check_holds(part, dormant, world);
      regions += !part.mesh.region.empty();
      for (const Subsegment& s : part.mesh.subsegments) several_sides += s.half[0] != kNone && s.half[1] != kNone;
    }
  }
  CHECK(regions > 0);
  CHECK(several_sides > 0);  // segments inside a subdomain
}

TEST_CASE("what sleeps in a scratch file leaves hardly anything in memory") {
  Triangulation mesh = triangulate(generate_pipe({}));
  prepare_corners(mesh);
  DecomposeOptions options;
  options.subdomains = 2;
  const Decomposition d = decompose(mesh, options);
  const TemporaryFolder folder;
  ScratchFile scratch(folder.path().string());
  SubdomainContext context{&d, {}, false};
  context.bounds.plain.area = d.subdomains[SubdomainId{0}].area / 10'000;
  context.scratch = &scratch;
  Subdomain subdomain(SubdomainId{0}, context);
  const std::size_t before = heap_bytes();
  std::vector<SplitPoint<GlobalRootId>> said;
  while (subdomain.active()) subdomain.work(10'000, said);
  said = {};
  const auto triangles = static_cast<std::size_t>(subdomain.triangles());
  subdomain.sleep();
  REQUIRE(triangles > 10'000);
  CHECK(heap_bytes() < before + 4 * triangles);
}

TEST_CASE("a mesh sleeps as small whichever way its border runs") {
  const auto bytes = [](bool clockwise) {
    constexpr std::int32_t kCorners = 300;
    Pslg polygon;
    for (std::int32_t i = 0; i < kCorners; ++i) {
      const double angle = (clockwise ? -2 : 2) * M_PI * i / kCorners, radius = i % 2 == 0 ? 1 : 0.9;
      polygon.points.push_back({radius * std::cos(angle), radius * std::sin(angle)});
      polygon.segments.push_back({i, (i + 1) % kCorners, 1});
    }
    SubdomainMesh part;
    part.mesh = triangulate(polygon);
    for (const VertexId v : ids_of(part.mesh.points)) part.points.push_back(GlobalPointId{to_int(v)});
    for (const RootId r : ids_of(part.mesh.roots)) part.roots.push_back(GlobalRootId{to_int(r)});
    return DormantMesh(part).bytes();
  };
  CHECK(bytes(false) <= 8188);  // it was as many when this was written
  CHECK(bytes(true) <= 8185);
}

TEST_CASE("a sleeping mesh takes at most 16 bytes per triangle, with everything that belongs to it") {
  std::vector<std::pair<std::string, Pslg>> models{{"pipe", generate_pipe({})},
                                                   {"flow", generate_cylinder_flow({})},
                                                   {"holes", generate_holes({})},
                                                   {"comb", generate_comb({})}};
  for (const std::string name : {"pipe", "cylinder_flow", "chesapeake", "key", "A"}) {
    const std::string path = DRIFTMESH_SOURCE_DIR "/../shared/data/" + name + ".poly";
    if (!std::filesystem::exists(path)) {
      MESSAGE("skipped: no " << path);
      continue;
    }
    models.emplace_back(name + ".poly", read_poly(path));
    repair(models.back().second);
  }
  for (const auto& [name, pslg] : models) {
    CAPTURE(name);
    Triangulation mesh = triangulate(pslg);
    prepare_corners(mesh);
    DecomposeOptions options;
    options.subdomains = 8;
    const Decomposition d = decompose(mesh, options);
    double area = 0;
    for (const auto& s : d.subdomains) area += s.area;
    SubdomainContext context{&d, {}, false};
    context.bounds.plain.area = area / 40'000;
    std::size_t bytes = 0, triangles = 0;
    for (const SubdomainId i : first_ids<SubdomainId>(8)) {
      const SubdomainMesh part = refined(context, i);
      const DormantMesh dormant(part);
      check_same(part, dormant);
      bytes += dormant.bytes();
      triangles += part.mesh.live_triangles();
    }
    MESSAGE(name << ": " << triangles << " triangles, " << static_cast<double>(bytes) / static_cast<double>(triangles)
                 << " bytes each");
    CHECK(bytes <= 16 * triangles);
    CHECK(bytes > 8 * triangles);  // the coordinates alone
  }
}
