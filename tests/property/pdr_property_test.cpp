#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "driftmesh/error.hpp"
#include "driftmesh/repair.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "mesh/digest.hpp"
#include "oracles/meshing.hpp"
#include "oracles/random_pslg.hpp"
#include "property/cases.hpp"
#include "study/pdr/lattice_place.hpp"
#include "study/pdr/part.hpp"
#include "support/adversarial_network.hpp"
#include "support/exchange_over.hpp"
#include "support/id_literals.hpp"
#include "verify/report_text.hpp"
#include "verify/verify.hpp"

// Partially coupled refinement: a lattice whose cells of one color do not meet, and one mesh of all ranks.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

struct Case {
  Pslg input;
  Triangulation mesh;
  QualityBounds bounds;
};

Case random_case(std::uint64_t seed) {
  Case c;
  c.input = oracles::make_random_pslg(seed, oracles::make_random_shape(seed)).input;
  repair(c.input);
  c.mesh = triangulate(c.input);
  c.bounds.min_angle = 20;
  prepare_corners(c.mesh, {c.bounds.min_angle, false});
  double area = 0;
  for (const TriangleId t : ids_of(c.mesh.triangles))
    if (c.mesh.triangles[t].alive()) area += signed_area(c.mesh.corner(t, 0), c.mesh.corner(t, 1), c.mesh.corner(t, 2));
  c.bounds.plain.area = area / 20'000;
  return c;
}

/// The ranks of a case, without any network.
struct Holders {
  IdVector<Rank, std::unique_ptr<pdr::Part>> all;
  pdr::Lattice lattice{{0, 0}, {1, 1}, 1, 1};

  Holders(const Case& c, std::int32_t ranks) {
    Triangulation mesh = c.mesh;
    lattice = pdr::start(mesh, c.bounds, ranks);
    for (const Rank r : first_ids<Rank>(ranks))
      all.push_back(std::make_unique<pdr::Part>(r, ranks, mesh, lattice, c.bounds));
  }
};

IdVector<Rank, Exchange*> refinements_of(const Holders& ranks) {
  IdVector<Rank, Exchange*> exchanges;
  for (const auto& one : ranks.all) exchanges.push_back(one.get());
  return exchanges;
}

void refine_directly(const Holders& ranks) {
  exchange_directly(refinements_of(ranks));
}

void check_mesh(const Case& c, const Mesh& mesh) {
  VerifyOptions options;
  options.min_angle = c.bounds.min_angle;
  options.plain.area = c.bounds.plain.area;
  options.plain.region_areas = false;
  const VerifyReport report = verify(mesh, c.input, options);
  const std::string text = verdict_text(report, options) + "\n" + report_text(report, options);
  INFO(text);
  CHECK(report.accepted());
}

using Place = std::pair<double, double>;

/// All that a triangle of the mesh is, without numbers.
using Shape = std::tuple<std::array<Place, 3>, double>;
using Line = std::tuple<Place, Place, std::int32_t>;

/// The triangles and subsegments that ranks have in their own cells, from their data structures alone.
struct Union {
  std::vector<Shape> triangles;
  std::set<Line> lines;
};

Place place_of(const Point& p) {
  return {p.x, p.y};
}

std::array<Place, 3> corners_of(const Point& a, const Point& b, const Point& c) {
  std::array<Place, 3> corners{place_of(a), place_of(b), place_of(c)};
  std::rotate(corners.begin(), std::ranges::min_element(corners), corners.end());
  return corners;
}

Union union_of(const Holders& ranks, const Case& c) {
  Union all;
  for (const Rank r : ids_of(ranks.all)) {
    const Triangulation& mesh = ranks.all[r]->mesh();
    const auto owns = [&](TriangleId t) {
      Place leftmost = place_of(mesh.corner(t, 0));
      for (int i = 1; i < 3; ++i) leftmost = std::min(leftmost, place_of(mesh.corner(t, i)));
      return ranks.lattice.owner_of(ranks.lattice.cell_of({leftmost.first, leftmost.second})) == r;
    };
    for (const TriangleId t : ids_of(mesh.triangles)) {
      if (!mesh.triangles[t].alive() || !owns(t)) continue;
      const std::size_t label = mesh.region.empty() ? 0 : mesh.region[t];
      all.triangles.emplace_back(corners_of(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)),
                                 label == 0 ? 0 : c.input.regions[label - 1].attribute);
    }
    for (const Subsegment& s : mesh.subsegments)
      if (s.is_leaf() && std::ranges::any_of(s.half, [&](HalfEdge h) { return h != kNone && owns(triangle_of(h)); }))
        all.lines.emplace(place_of(mesh.points[s.vertex[0]]), place_of(mesh.points[s.vertex[1]]),
                          mesh.roots[s.root].marker);
  }
  std::ranges::sort(all.triangles);
  return all;
}

/// The whole mesh. Triangles that two ranks have, or none, do not escape a check of it.
Mesh whole_of(const Holders& ranks, const Case& c) {
  const Union all = union_of(ranks, c);
  Mesh mesh;
  std::map<Place, std::int32_t> numbers;
  const auto number = [&](const Place& place) {
    const auto [known, is_new] = numbers.try_emplace(place, static_cast<std::int32_t>(mesh.points.size()));
    if (is_new) mesh.points.push_back({place.first, place.second});
    return known->second;
  };
  for (const auto& [corners, region] : all.triangles) {
    mesh.triangles.push_back({number(corners[0]), number(corners[1]), number(corners[2])});
    if (!c.input.regions.empty()) mesh.regions.push_back(region);
  }
  for (const auto& [a, b, marker] : all.lines) mesh.edges.push_back({number(a), number(b), marker});
  return mesh;
}

bool same_mesh(const Mesh& a, const Mesh& b) {
  return a.points == b.points && a.triangles == b.triangles && a.edges == b.edges;
}

struct MostSeen final : job::Watch {
  std::int64_t most = 0;
  void refining(std::int64_t triangles, double /*forecast*/) override { most = std::max(most, triangles); }
};

}  // namespace

TEST_CASE("cells of one color keep apart, and ranks agree who follows whom") {
  std::mt19937_64 random = seeded_generator("lattice");
  for (std::int64_t i = 0; i < case_count(200); ++i) {
    const auto ranks = static_cast<std::int32_t>(1 + random() % 12);
    const pdr::Lattice lattice({0, 0}, {1.0 + random() % 20, 1.0 + random() % 20}, 1, ranks);
    CAPTURE(lattice.columns());
    CAPTURE(lattice.rows());
    CAPTURE(ranks);
    for (std::int32_t k = 0; k < lattice.columns() * lattice.rows(); ++k) {
      const pdr::Cell a{k % lattice.columns(), k / lattice.columns()};
      CHECK(lattice.cell_of({a.column + 0.5, a.row + 0.5}) == a);
      CHECK(to_int(lattice.owner_of(a)) < ranks);
      for (std::int32_t j = 0; j < lattice.columns() * lattice.rows(); ++j) {
        const pdr::Cell b{j % lattice.columns(), j / lattice.columns()};
        const std::int32_t apart = std::max(std::abs(a.column - b.column), std::abs(a.row - b.row));
        if (a != b && pdr::Lattice::color_of(a) == pdr::Lattice::color_of(b)) CHECK(apart >= 2);
        const Rank other = lattice.owner_of(b);
        if (other == lattice.owner_of(a) || apart > pdr::Lattice::kReach) continue;
        CHECK(std::ranges::count(lattice.followers_of(a), other) == 1);
        CHECK(std::ranges::count(lattice.neighbors_of(lattice.owner_of(a)), other) == 1);
        CHECK(std::ranges::count(lattice.neighbors_of(other), lattice.owner_of(a)) == 1);
      }
    }
  }
}

TEST_CASE("random domains on any number of ranks make one mesh that meets the bounds") {
  std::int64_t told = 0;
  const auto cases = static_cast<std::uint64_t>(case_count(20));
  for (std::uint64_t seed = 1; seed <= cases; ++seed) {
    CAPTURE(seed);
    const Case c = random_case(seed);
    CAPTURE(oracles::poly_text(c.input));
    for (const std::int32_t ranks : {1, 2, 4}) {
      CAPTURE(ranks);
      const Holders all(c, ranks);
      refine_directly(all);
      check_mesh(c, whole_of(all, c));
      for (const auto& one : all.all) told += one->told();
    }
  }
  MESSAGE(told << " points told");
  CHECK(told > 0);
}

TEST_CASE("an adversarial network does not change the mesh") {
  std::uint64_t reordered = 0;
  const auto cases = static_cast<std::uint64_t>(case_count(20));
  for (std::uint64_t seed = 1; seed <= cases; ++seed) {
    CAPTURE(seed);
    const Case c = random_case(seed % 5 + 1);
    const auto count = static_cast<std::int32_t>(2 + seed % 3);
    const Holders all(c, count), undisturbed(c, count);
    protocol::AdversarialNetwork network(count, protocol::Adversary::from_seed(seed));
    exchange_over(network, refinements_of(all));
    refine_directly(undisturbed);
    const Mesh mesh = whole_of(all, c);
    check_mesh(c, mesh);
    CHECK(same_mesh(mesh, whole_of(undisturbed, c)));
    reordered += network.counters().reordered;
  }
  CHECK(reordered > 0);
}

TEST_CASE("simulated ranks make the same mesh, and time passes for all that they insert") {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    CAPTURE(seed);
    const Case c = random_case(seed);
    constexpr std::int32_t kRanks = 4;
    const Holders direct(c, kRanks);
    refine_directly(direct);
    const Mesh mesh = whole_of(direct, c);

    ClusterSpec cluster;
    cluster.groups = {{"fast", 3, 0}, {"slow", 1, reference_speed({}) / 8}};
    MostSeen progress;
    job::RunRecord record;
    job::Order order;
    order.whole.emplace().triangulated.mesh = c.mesh;
    order.whole->triangulated.bounds = c.bounds;
    const auto refined = pdr::SimulatedLattice(cluster).refine(std::move(order), job::Limits{}, nullptr, progress);
    refined->report(record);
    const ClusterRun run = refined->history();
    std::uint64_t expected = 0;
    for (const Rank r : ids_of(direct.all)) {
      const job::MeshFacts own = direct.all[r]->keep_own(c.bounds);
      expected += mesh_digest(direct.all[r]->mesh());
      CHECK(run.ranks[r].triangles == own.triangles);
      CHECK(own.triangles == static_cast<std::int64_t>(direct.all[r]->mesh().live_triangles()));
    }
    CHECK(record.digest == expected);
    CHECK(run.triangles() == static_cast<std::int64_t>(mesh.triangles.size()));
    CHECK(record.vertices == static_cast<std::int64_t>(mesh.points.size()));
    CHECK(record.subsegments == static_cast<std::int64_t>(mesh.edges.size()));
    CHECK(progress.most > run.triangles() / 2);
    const CostModel costs;
    for (const Rank r : ids_of(run.ranks)) {
      const RankOutcome& rank = run.ranks[r];
      const auto& counters = direct.all[r]->cells().counters();
      const auto inserted = static_cast<double>(counters.free_points + counters.segment_points);
      const double slowness = r == 3_rank ? 8 : 1;
      CHECK(rank.times.computing > slowness * costs.point * inserted);  // the start comes on top
      CHECK(rank.times.total() <= run.makespan * (1 + 1e-9));
      CHECK(rank.times.idle >= 0);
      std::size_t mail = 0;  // to a neighbor for each from it
      for (int round = 0; round < direct.all[r]->rounds(); ++round) mail += direct.all[r]->senders(round).size();
      CHECK(rank.messages == mail);
      CHECK(rank.counters.splits_sent == direct.all[r]->told());
    }
    CHECK(run.ranks[0_rank].times.idle > run.ranks[3_rank].times.idle);
  }
}
