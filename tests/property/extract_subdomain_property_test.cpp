#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "decompose/extract_subdomain.hpp"
#include "driftmesh/error.hpp"
#include "mesh/triangulation_fault.hpp"
#include "migration/dormant_mesh.hpp"
#include "property/cases.hpp"
#include "support/changed_decomposition.hpp"
#include "support/error_text.hpp"
#include "support/random_subdomains.hpp"
#include "support/refine_together.hpp"

// Subdomains of changed decompositions, taken from refined meshes of those before.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

/// Corners in their order, with the label of the region.
using Corners = std::pair<std::array<std::pair<double, double>, 3>, int>;

std::multiset<Corners> triangles_of(const Triangulation& mesh) {
  std::multiset<Corners> all;
  for (const TriangleId t : ids_of(mesh.triangles)) {
    if (!mesh.triangles[t].alive()) continue;
    Corners corners{{}, mesh.region.empty() ? 0 : mesh.region[t]};
    for (int i = 0; i < 3; ++i) corners.first[static_cast<std::size_t>(i)] = {mesh.corner(t, i).x, mesh.corner(t, i).y};
    all.insert(corners);
  }
  return all;
}

/// What is wrong with a part apart from which triangles it has; empty: nothing.
std::string fault_of(const ExtractedSubdomain& extracted, const SubdomainMesh& from, const Decomposition& now,
                     SubdomainId s) {
  const auto& [part, vertex, triangle] = extracted;
  const Triangulation& mesh = part.mesh;
  if (std::string fault = triangulation_fault(mesh); !fault.empty()) return fault;
  if (!mesh.free_triangles.empty() || !mesh.free_vertices.empty()) return "free slots";
  const SubdomainMesh fresh = subdomain_triangulation(now, s);
  if (part.roots != fresh.roots) return "other roots than those of a fresh one";
  for (const RootId r : ids_of(part.roots)) {
    const RootSegment &own = mesh.roots[r], &other = fresh.mesh.roots[r];
    for (const std::size_t end : {0U, 1U})
      if (part.points[own.vertex[end]] != fresh.points[other.vertex[end]]) return "another end of a root";
    if (own.marker != other.marker || own.shell != other.shell) return "another root";
  }
  if (part.points.size() != fresh.points.size()) return "more or fewer points than of a fresh one";
  for (const VertexId v : ids_of(fresh.points)) {
    const auto own =
        static_cast<VertexId>(std::ranges::lower_bound(part.points, fresh.points[v]) - part.points.begin());
    if (part.points[own] != fresh.points[v] || mesh.origin[own] != fresh.mesh.origin[v] ||
        !(mesh.points[own] == fresh.mesh.points[v]))
      return "another point";
  }
  if (vertex.size() != mesh.points.size() || triangle.size() != mesh.triangles.size()) return "sizes";
  if (!std::is_sorted(vertex.begin() + static_cast<std::ptrdiff_t>(part.points.size()), vertex.end()) ||
      !std::is_sorted(triangle.begin(), triangle.end()))
    return "another order";
  for (const VertexId v : ids_of(vertex))
    if (!(mesh.points[v] == from.mesh.points[vertex[v]])) return "a vertex was elsewhere";
  for (const TriangleId t : ids_of(triangle))
    for (int i = 0; i < 3; ++i)
      if (vertex[mesh.triangles[t].vertex[i]] != from.mesh.triangles[triangle[t]].vertex[i]) return "another corner";
  for (const VertexId v : ids_of(vertex))  // a free one is free, and others are midpoints or points
    if ((from.mesh.origin[vertex[v]] == kFree) != (mesh.origin[v] == kFree)) return "another kind of vertex";
  const SubdomainMesh woken = DormantMesh(part).wake();
  if (triangles_of(woken.mesh).size() != mesh.triangles.size()) return "packed";
  return "";
}

/// The split points of the roots that they become, by paths alone.
SplitPoints renamed_points(const SplitPoints& points, const Broken& broken, const Decomposition& before) {
  SplitPoints all;
  for (const auto& [name, splits] : points) {
    const auto chain = broken.renamed.find(name);
    if (chain == broken.renamed.end()) {
      all[name] = splits;
      continue;
    }
    for (const RootInterval& piece : chain->second)
      for (const auto& [path, point] : splits) {
        if (!dyadic::is_ancestor(piece.interval, path)) continue;
        const int down = dyadic::depth(path) - dyadic::depth(piece.interval);
        const dyadic::Path whole = dyadic::Path{1} << down, below = path - (piece.interval << down);
        const Decomposition::Root& root = broken.decomposition.roots[piece.root];
        const auto& at = broken.decomposition.points;
        const Point &a = at[root.a], &b = at[root.b], &from = at[before.roots[name].a], &to = at[before.roots[name].b];
        const bool along = (b.x - a.x) * (to.x - from.x) + (b.y - a.y) * (to.y - from.y) > 0;
        all[piece.root][whole + (along ? below : whole - 1 - below)] = point;
      }
  }
  return all;
}

SplitPoints points_of_all(const IdVector<SubdomainId, SubdomainMesh>& parts) {
  SplitPoints all;
  for (const SubdomainMesh& part : parts) all.merge(split_points(part));
  return all;
}

/// Checks all subdomains of `now`, taken from `parts`, and returns them.
IdVector<SubdomainId, SubdomainMesh> extract_all(const IdVector<SubdomainId, SubdomainMesh>& parts,
                                                 const Broken& change,
                                                 const IdVector<SubdomainId, SubdomainId>& parent) {
  IdVector<SubdomainId, SubdomainMesh> all;
  IdVector<SubdomainId, std::multiset<Corners>> of_parent(parts.size());
  for (const SubdomainId s : ids_of(parent)) {
    const SubdomainMesh& from = parts[parent[s]];
    ExtractedSubdomain extracted = extract_subdomain(from, change.renamed, change.decomposition, s);
    CHECK(fault_of(extracted, from, change.decomposition, s) == "");
    of_parent[parent[s]].merge(triangles_of(extracted.part.mesh));
    CHECK(summarize_angles(extracted.part.mesh).total_area ==
          doctest::Approx(change.decomposition.subdomains[s].area).epsilon(1e-9));
    all.push_back(std::move(extracted.part));
  }
  for (const SubdomainId p : ids_of(parts)) CHECK(of_parent[p] == triangles_of(parts[p].mesh));
  return all;
}

IdVector<SubdomainId, SubdomainId> same_parents(const Decomposition& d) {
  const IdRange<SubdomainId> ids = ids_of(d.subdomains);
  return {ids.begin(), ids.end()};
}

/// Refines each on its own, with smaller triangles.
void refine_further(IdVector<SubdomainId, SubdomainMesh> parts, QualityBounds bounds) {
  bounds.plain.area /= 2;
  for (SubdomainMesh& part : parts) {
    Refiner(part.mesh, bounds).refine();
    CHECK(triangulation_fault(part.mesh) == "");
    CHECK(find_exceptions(part.mesh, bounds).large.empty());
  }
}

}  // namespace

TEST_CASE("without changes, subdomains are what they were") {
  auto seeds = seeded_generator("the same subdomains");
  std::size_t slots = 0;
  for (std::int64_t i = case_count(40); i > 0; --i) {
    const std::uint64_t seed = seeds() % 100'000;
    CAPTURE(seed);
    RandomSubdomains world(seed, static_cast<int>(1 + seed % 6), 400);
    const Decomposition& d = *world.context().decomposition;
    const auto refined = refine_together(d, world.context().bounds);
    for (const SubdomainMesh& part : refined.parts) slots += part.mesh.free_triangles.size();
    const auto again = extract_all(refined.parts, {d, {}}, same_parents(d));
    CHECK(points_of_all(again) == points_of_all(refined.parts));
  }
  MESSAGE(slots << " free slots");
  CHECK(slots > 0);
}

TEST_CASE("roots that become chains keep the points on them, any number of times") {
  auto seeds = seeded_generator("chains of roots");
  std::size_t chains = 0, roots = 0, turned = 0;
  for (std::int64_t i = case_count(40); i > 0; --i) {
    const std::uint64_t seed = seeds() % 100'000;
    CAPTURE(seed);
    RandomSubdomains world(seed, static_cast<int>(1 + seed % 6), 600);
    Broken change{*world.context().decomposition, {}};
    auto parts = refine_together(change.decomposition, world.context().bounds).parts;
    for (const int time : {1, 2}) {
      CAPTURE(time);
      const SplitPoints points = points_of_all(parts);
      const Decomposition before = change.decomposition;
      change = broken(before, points, 3, world.random());
      parts = extract_all(parts, change, same_parents(before));
      CHECK(points_of_all(parts) == renamed_points(points, change, before));
      chains += change.renamed.size();
      for (const auto& [name, chain] : change.renamed) {
        roots += chain.size();
        for (const RootInterval& piece : chain)
          turned += change.decomposition.roots[piece.root].left != before.roots[name].left;
      }
    }
    refine_further(std::move(parts), world.context().bounds);
  }
  MESSAGE(chains << " chains of " << roots << " roots, " << turned << " turned around");
  CHECK(chains > 20);
  CHECK(turned > 20);
}

TEST_CASE("a subdomain is divided along roots inside it") {
  auto seeds = seeded_generator("divided subdomains");
  std::int64_t divided = 0, with_chains = 0;
  for (std::int64_t i = case_count(40); i > 0; --i) {
    const std::uint64_t seed = seeds() % 100'000;
    CAPTURE(seed);
    RandomSubdomains world(seed, static_cast<int>(2 + seed % 6), 400);
    const Decomposition& d = *world.context().decomposition;
    const std::vector<Interface> pairs = interfaces(d);
    if (pairs.empty()) continue;
    const Interface& pair = pairs[world.random()() % pairs.size()];
    const Merged coarse = merged(d, pair.first, pair.second);
    const auto refined = refine_together(coarse.decomposition, world.context().bounds);
    const Broken change = seed % 2 == 0 ? Broken{d, {}} : broken(d, points_of_all(refined.parts), 4, world.random());
    refine_further(extract_all(refined.parts, change, coarse.parent), world.context().bounds);
    ++divided;
    with_chains += !change.renamed.empty();
  }
  MESSAGE(divided << " divided, " << with_chains << " with chains of roots");
  CHECK(2 * divided > case_count(40));
}

TEST_CASE("a decomposition that does not continue the mesh's is refused") {
  RandomSubdomains world(3, 3, 300);
  const Decomposition& d = *world.context().decomposition;
  const auto parts = refine_together(d, world.context().bounds).parts;
  const auto refusal = [&](const Broken& change, SubdomainId s) {
    return error_text([&] { (void)extract_subdomain(parts[SubdomainId{0}], change.renamed, change.decomposition, s); });
  };
  const GlobalRootId root = d.roots_of(SubdomainId{0}).front();
  SUBCASE("another subdomain") {
    CHECK(mentions(refusal({d, {}}, SubdomainId{1}), "does not have root"));
  }
  SUBCASE("a point that is not in the mesh") {
    const dyadic::Path deep = dyadic::Path{1} << 50;
    const Broken change{d, {{root, {{deep, root}}}}};
    CHECK(mentions(refusal(change, SubdomainId{0}), "broken at a point that the mesh does not have"));
  }
  SUBCASE("an end that is elsewhere") {
    Broken change{d, {}};
    change.decomposition.points[d.roots[root].a].x += 1;
    CHECK(mentions(refusal(change, SubdomainId{0}), "has other ends"));
  }
  SUBCASE("a side that is another's") {
    Broken change{d, {}};
    Decomposition::Root& changed = change.decomposition.roots[root];
    std::swap(changed.left, changed.right);
    CHECK(mentions(refusal(change, SubdomainId{0}), "cannot be taken from the mesh"));
  }
}
