#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/disjoint_sets.hpp"
#include "decompose/check_decomposition.hpp"
#include "decompose/decompose.hpp"
#include "decompose/further_cut.hpp"
#include "decompose/glue_subdomains.hpp"
#include "decompose/with_cuts.hpp"
#include "decompose/with_joins.hpp"
#include "driftmesh/error.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/exceptions.hpp"
#include "mesh/triangulation_fault.hpp"
#include "oracles/random_pslg.hpp"
#include "property/cases.hpp"
#include "support/prepared_mesh.hpp"
#include "support/refine_together.hpp"

// Subdomains become one: their meshes are put together triangle by triangle, and a division is undone.

using namespace driftmesh;
using namespace driftmesh::oracles;
using testing::prepared;

namespace {

using Groups = IdVector<SubdomainId, SubdomainId>;
using Corner = std::array<double, 2>;

Corner corner_at(const Point& p) {
  return {p.x, p.y};
}

/// A random domain that has been cut and refined.
struct Domain {
  explicit Domain(std::mt19937_64& random) {
    const Triangulation mesh = prepared(make_random_pslg(random(), make_random_shape(random())).input);
    area = summarize_angles(mesh).total_area;
    bounds = {.min_angle = 20, .plain = {.area = area / 400}};
    try {
      decomposition = decompose(mesh, {.subdomains = static_cast<std::int32_t>(2 + random() % 9), .bounds = bounds});
    } catch (const Error&) {  // no room for so many
    }
  }
  [[nodiscard]] const Decomposition& get() const { return *decomposition; }

  std::optional<Decomposition> decomposition;
  double area = 0;
  QualityBounds bounds;
};

/// Neighbors across some separators are joined.
Groups random_groups(const Decomposition& d, std::mt19937_64& random) {
  DisjointSets<SubdomainId> sets(d.size());
  const std::uint64_t every = 1 + random() % 4;
  for (const Decomposition::Root& root : d.roots)
    if (root.separator && random() % every == 0) sets.join(root.left, root.right);
  Groups groups;
  for (const SubdomainId s : ids_of(d.subdomains)) groups.push_back(sets.find(s));
  return groups;
}

Groups alone(const Decomposition& d) {
  const auto numbers = ids_of(d.subdomains);
  return {numbers.begin(), numbers.end()};
}

IdVector<SubdomainId, std::vector<SubdomainId>> members_of(const JoinedSubdomains& joined) {
  IdVector<SubdomainId, std::vector<SubdomainId>> members(joined.decomposition.size());
  for (const SubdomainId s : ids_of(joined.whole)) members[joined.whole[s]].push_back(s);
  return members;
}

std::multiset<std::array<Corner, 3>> triangles_of(const std::vector<const SubdomainMesh*>& meshes) {
  std::multiset<std::array<Corner, 3>> all;
  for (const SubdomainMesh* part : meshes)
    for (const Triangle& t : part->mesh.triangles) {
      if (!t.alive()) continue;
      std::array<Corner, 3> corners{};
      for (std::size_t i = 0; i < 3; ++i) corners[i] = corner_at(part->mesh.points[t.vertex[i]]);
      std::rotate(corners.begin(), std::ranges::min_element(corners), corners.end());
      all.insert(corners);
    }
  return all;
}

std::set<Corner> points_in(const std::vector<const SubdomainMesh*>& meshes) {
  std::set<Corner> all;
  for (const SubdomainMesh* part : meshes)
    for (const VertexId v : ids_of(part->mesh.points))
      if (part->mesh.origin[v] != kDeleted) all.insert(corner_at(part->mesh.points[v]));
  return all;
}

/// What is wrong with the mesh of a subdomain that consists of others; empty: nothing.
std::string glued_fault(const GluedSubdomain& glued, const std::vector<const SubdomainMesh*>& meshes,
                        const Decomposition& now, SubdomainId s) {
  const Triangulation& mesh = glued.part.mesh;
  if (std::string fault = triangulation_fault(mesh); !fault.empty()) return fault;
  if (triangles_of({&glued.part}) != triangles_of(meshes)) return "other triangles";
  if (points_in({&glued.part}) != points_in(meshes)) return "other points";
  if (mesh.points.size() != points_in(meshes).size()) return "a point twice";
  if (!std::ranges::equal(glued.part.roots, now.roots_of(s))) return "other roots";
  if (glued.part.points != points_of(now, s)) return "other points of the decomposition";
  for (const RootId r : ids_of(mesh.roots)) {
    const Decomposition::Root& root = now.roots[glued.part.roots[r]];
    const Subsegment& tree = mesh.subsegments[mesh.roots[r].tree];
    if (!(mesh.points[tree.vertex[0]] == now.points[root.a]) || !(mesh.points[tree.vertex[1]] == now.points[root.b]))
      return "other ends of a root";
    if (mesh.roots[r].marker != root.marker || mesh.roots[r].shell != root.shell) return "a root is another one";
  }
  for (const VertexId v : ids_of(mesh.points)) {
    const auto& [from, id] = glued.vertex[v];
    if (!(meshes[to_index(from)]->mesh.points[id] == mesh.points[v])) return "a vertex comes from elsewhere";
  }
  for (const TriangleId t : ids_of(mesh.triangles)) {
    const auto& [from, id] = glued.triangle[t];
    const Triangulation& old = meshes[to_index(from)]->mesh;
    for (const int i : {0, 1, 2})
      if (!(old.corner(id, i) == mesh.corner(t, i))) return "a triangle comes from elsewhere";
    if (!mesh.region.empty() && mesh.region[t] != (old.region.empty() ? 0 : old.region[id])) return "another region";
  }
  return "";
}

/// The same for all subdomains.
std::string joined_fault(const JoinedSubdomains& joined, const IdVector<SubdomainId, SubdomainMesh>& parts,
                         std::map<Renaming, std::size_t>& renamings) {
  const auto members = members_of(joined);
  for (const SubdomainId s : ids_of(members)) {
    std::vector<const SubdomainMesh*> meshes;
    for (const SubdomainId p : members[s]) meshes.push_back(&parts[p]);
    const GluedSubdomain glued = glue_subdomains(meshes, joined, s);
    if (std::string fault = glued_fault(glued, meshes, joined.decomposition, s); !fault.empty())
      return "subdomain " + to_string(s) + ": " + fault;
    if (meshes.size() > 1) continue;
    const Renaming renaming = renaming_of(*meshes[0], joined);
    ++renamings[renaming];
    if (renaming == Renaming::kRoots) continue;
    const SubdomainMesh renamed = renamed_subdomain(*meshes[0], joined);
    if (std::string fault = triangulation_fault(renamed.mesh); !fault.empty()) return fault;
    if (renamed.roots != glued.part.roots) return "names of roots";
    IdVector<VertexId, GlobalPointId> points = renamed.points;
    std::ranges::sort(points);
    if (points != glued.part.points) return "names of points";
    for (const VertexId v : ids_of(renamed.points)) {
      if (renamed.mesh.origin[v] != origin_of(joined.decomposition, renamed.points[v])) return "the origin of a point";
      if (!(joined.decomposition.points[renamed.points[v]] == renamed.mesh.points[v])) return "the name of a point";
    }
    if (renaming == Renaming::kNothing && (renamed.roots != meshes[0]->roots || renamed.points != meshes[0]->points))
      return "a subdomain has changed";
  }
  return "";
}

}  // namespace

TEST_CASE("subdomains that become one keep each point and triangle") {
  std::size_t several = 0, fewer_points = 0;
  std::map<Renaming, std::size_t> renamings;
  std::mt19937_64 seeds = testing::seeded_generator("joins");
  for (std::int64_t i = 0; testing::more_cases(i, 40, several > 20 && renamings.size() == 3); ++i) {
    const std::uint64_t seed = seeds();
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Domain domain(random);
    if (!domain.decomposition) continue;
    const Decomposition& d = domain.get();
    const testing::RefinedTogether refined = testing::refine_together(d, domain.bounds);
    REQUIRE(refined.complete);
    const Groups groups = random_groups(d, random);
    const JoinedSubdomains joined = with_joins(d, groups);
    const DecompositionReport report = check_decomposition(joined.decomposition);
    CHECK((report.valid() ? "" : report.problems[0]) == "");
    CHECK(report.area == doctest::Approx(domain.area).epsilon(1e-9));
    CHECK(joined.decomposition.size() == static_cast<std::size_t>(std::ranges::count_if(
                                             ids_of(groups), [&](SubdomainId s) { return groups[s] == s; })));
    CHECK(joined_fault(joined, refined.parts, renamings) == "");
    const testing::RefinedTogether again = testing::refine_together(joined.decomposition, domain.bounds);
    CHECK(again.complete);
    CHECK(again.refused == 0);
    CHECK(again.not_conforming == std::vector<std::string>{});
    several += d.size() - joined.decomposition.size();
    fewer_points += d.points.size() - joined.decomposition.points.size();
  }
  MESSAGE(several << " joined, " << fewer_points << " points gone, " << renamings[Renaming::kNothing]
                  << " as they were, " << renamings[Renaming::kNumbers] << " with other numbers, "
                  << renamings[Renaming::kRoots] << " with other roots");
  CHECK(several > 20);
  CHECK(fewer_points > 0);
  CHECK(renamings.size() == 3);
}

TEST_CASE("joining what was divided undoes the division") {
  std::size_t undone = 0, chains = 0;
  std::map<Renaming, std::size_t> renamings;
  std::mt19937_64 seeds = testing::seeded_generator("divisions that are undone");
  for (std::int64_t i = 0; testing::more_cases(i, 40, undone > 20 && chains > 20); ++i) {
    const std::uint64_t seed = seeds();
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    Domain domain(random);
    if (!domain.decomposition) continue;
    const Decomposition d = with_joins(domain.get(), alone(domain.get())).decomposition;  // without halves of roots
    const testing::RefinedTogether refined = testing::refine_together(d, domain.bounds);
    std::vector<FurtherCut> cuts;
    for (const SubdomainId s : ids_of(d.subdomains))
      if (random() % 2 == 0)
        if (auto cut =
                cut_further(d, s, refined.parts[s], domain.bounds, 500, static_cast<std::int32_t>(2 + random() % 5)))
          cuts.push_back(*std::move(cut));
    if (cuts.empty()) continue;
    const CutFurther cut = with_cuts(d, cuts);
    const JoinedSubdomains joined = with_joins(cut.divided, cut.whole_of);
    const Decomposition& back = joined.decomposition;
    CHECK(back.points == d.points);
    CHECK(back.origin == d.origin);
    CHECK(back.roots == d.roots);
    CHECK(back.root_list == d.root_list);
    CHECK(back.point_begin == d.point_begin);
    CHECK(back.point_list == d.point_list);
    REQUIRE(back.size() == d.size());
    for (const SubdomainId s : ids_of(d.subdomains)) {
      CHECK(back.subdomains[s].area == doctest::Approx(d.subdomains[s].area).epsilon(1e-9));
      CHECK(back.subdomains[s].centroid.x ==
            doctest::Approx(d.subdomains[s].centroid.x).epsilon(1e-6).scale(std::sqrt(domain.area)));
    }
    const testing::RefinedTogether parts = testing::refine_together(cut.divided, domain.bounds);
    REQUIRE(parts.complete);
    CHECK(joined_fault(joined, parts.parts, renamings) == "");
    undone += cuts.size();
    chains += cut.renamed.size();
  }
  MESSAGE(undone << " divisions undone, " << chains << " roots in one piece again");
  CHECK(undone > 20);
  CHECK(chains > 20);
}
