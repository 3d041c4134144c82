#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <set>

#include "distributed/ghost_layer.hpp"
#include "mesh/digest.hpp"
#include "mesh/merge_pieces.hpp"
#include "migration/dormant_mesh.hpp"
#include "oracles/meshing.hpp"
#include "property/cases.hpp"
#include "support/adversarial_network.hpp"
#include "support/check_pieces.hpp"
#include "support/distributed_case.hpp"
#include "support/exchange_over.hpp"
#include "support/mesh_equality.hpp"
#include "verify/report_text.hpp"
#include "verify/verify.hpp"

// Random domains, decomposed, refined, and distributed to ranks at random: the ranks assemble one mesh.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

void check_whole(const DistributedCase& c, const std::vector<DistributedPiece>& pieces, const Mesh& whole) {
  std::uint64_t digest_of_parts = 0, digest_of_pieces = 0;
  for (const SubdomainMesh& part : c.parts) digest_of_parts += mesh_digest(part.mesh);
  for (const DistributedPiece& piece : pieces) digest_of_pieces += mesh_digest(piece.mesh);
  CHECK(digest_of_pieces == digest_of_parts);
  CHECK(mesh_digest(whole) == digest_of_parts);
  VerifyOptions options;
  options.min_angle = c.bounds.min_angle;
  options.plain.area = c.bounds.plain.area;
  options.plain.region_areas = false;
  const VerifyReport report = verify_pieces(meshes_of(pieces), &c.input, options);
  const std::string text = verdict_text(report, options) + "\n" + report_text(report, options);
  INFO(text);
  CHECK(report.accepted());
}

/// Triangles by the places of their corners, beginning with the lowest.
using Corners = std::array<Place, 3>;

Corners corners_of(const Mesh& mesh, std::size_t t) {
  Corners corners;
  for (std::size_t i = 0; i < 3; ++i) {
    const Point& p = mesh.points[static_cast<std::size_t>(mesh.triangles[t][i])];
    corners[i] = {p.x, p.y};
  }
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  return corners;
}

/// What every triangle of all pieces should be on any rank that has it as a ghost.
struct Expected {
  Rank owner{};
  std::int32_t subdomain = 0;
  double region = 0;
  friend bool operator==(const Expected&, const Expected&) = default;
};

double region_of(const Mesh& mesh, std::size_t t) {
  return mesh.regions.empty() ? 0 : mesh.regions[t];
}

std::map<Corners, Expected> triangles_of(const std::vector<DistributedPiece>& pieces) {
  std::map<Corners, Expected> all;
  for (const DistributedPiece& piece : pieces)
    for (std::size_t t = 0; t < piece.mesh.triangles.size(); ++t)
      all[corners_of(piece.mesh, t)] = {piece.rank, piece.mesh.subdomains[t], region_of(piece.mesh, t)};
  return all;
}

/// The ring that a search of all pieces by coordinates finds: nothing of it is missing, nothing else is there.
std::map<Corners, Expected> ring_around(const DistributedPiece& piece, const std::map<Corners, Expected>& all) {
  const std::set<Place> own = places_of(piece.mesh);
  std::map<Corners, Expected> ring;
  for (const auto& [corners, expected] : all)
    if (expected.owner != piece.rank && std::ranges::any_of(corners, [&](const Place& p) { return own.contains(p); }))
      ring[corners] = expected;
  return ring;
}

/// The piece is there unchanged, in front.
void check_front(const DistributedPiece& piece, const GhostedPiece& ghosted) {
  const auto begins_with = [](const auto& all, const auto& front) {
    return all.size() >= front.size() && std::equal(front.begin(), front.end(), all.begin());
  };
  CHECK(ghosted.rank == piece.rank);
  CHECK(ghosted.ranks == piece.ranks);
  CHECK(static_cast<std::size_t>(ghosted.own_points) == piece.mesh.points.size());
  CHECK(static_cast<std::size_t>(ghosted.own_triangles) == piece.mesh.triangles.size());
  CHECK(static_cast<std::size_t>(ghosted.own_edges) == piece.mesh.edges.size());
  CHECK(begins_with(ghosted.mesh.points, piece.mesh.points));
  CHECK(begins_with(ghosted.mesh.triangles, piece.mesh.triangles));
  CHECK(begins_with(ghosted.mesh.edges, piece.mesh.edges));
  CHECK(begins_with(ghosted.owners, piece.owners));
}

void check_ghost_points(const GhostedPiece& ghosted, const Mesh& whole, const std::map<std::int64_t, Rank>& owners) {
  const Mesh& mesh = ghosted.mesh;
  REQUIRE(mesh.numbers.size() == mesh.points.size());
  REQUIRE(mesh.point_markers.size() == mesh.points.size());
  const auto width = static_cast<std::size_t>(whole.attributes_per_point);
  REQUIRE(mesh.attributes.size() == mesh.points.size() * width);
  CHECK(std::set(mesh.numbers.begin(), mesh.numbers.end()).size() == mesh.numbers.size());
  CHECK(std::is_sorted(mesh.numbers.begin() + ghosted.own_points, mesh.numbers.end()));
  std::set<std::int32_t> used;
  for (const auto& t : mesh.triangles) used.insert(t.begin(), t.end());
  CHECK(used.size() == mesh.points.size());
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    const auto number = static_cast<std::size_t>(mesh.numbers[v]);
    CHECK(mesh.points[v] == whole.points[number]);
    CHECK(mesh.point_markers[v] == whole.point_markers[number]);
    CHECK(ghosted.owners[v] == owners.at(mesh.numbers[v]));
    for (std::size_t i = 0; i < width; ++i)
      CHECK(mesh.attributes[v * width + i] == whole.attributes[number * width + i]);
  }
}

void check_ghost_triangles(const GhostedPiece& ghosted, const Mesh& whole, const std::map<Corners, Expected>& ring) {
  const Mesh& mesh = ghosted.mesh;
  REQUIRE(ghosted.triangle_numbers.size() == mesh.triangles.size());
  std::map<Corners, Expected> found;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    CHECK(corners_of(mesh, t) == corners_of(whole, static_cast<std::size_t>(ghosted.triangle_numbers[t])));
    if (t >= static_cast<std::size_t>(ghosted.own_triangles))
      found[corners_of(mesh, t)] = {Rank{mesh.ranks[t]}, mesh.subdomains[t], region_of(mesh, t)};
  }
  CHECK(found == ring);
  CHECK(found.size() == mesh.triangles.size() - static_cast<std::size_t>(ghosted.own_triangles));
  CHECK(std::is_sorted(ghosted.triangle_numbers.begin() + ghosted.own_triangles, ghosted.triangle_numbers.end()));
}

/// Subsegments of the whole mesh that are sides of ghosts, apart from those that the piece has.
void check_ghost_edges(const GhostedPiece& ghosted, const Mesh& whole) {
  const Mesh& mesh = ghosted.mesh;
  using Ends = std::pair<std::int64_t, std::int64_t>;
  const auto ends = [](std::int64_t a, std::int64_t b) { return Ends(std::min(a, b), std::max(a, b)); };
  const auto number = [&](std::int32_t v) { return mesh.numbers[static_cast<std::size_t>(v)]; };
  std::set<Ends> sides;
  for (std::size_t t = static_cast<std::size_t>(ghosted.own_triangles); t < mesh.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i)
      sides.insert(ends(number(mesh.triangles[t][i]), number(mesh.triangles[t][(i + 1) % 3])));
  std::map<Ends, std::int32_t> expected, actual;
  for (const Mesh::Edge& e : whole.edges)
    if (sides.contains(ends(e.a, e.b))) expected[ends(e.a, e.b)] = e.marker;
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    const Ends of_edge = ends(number(mesh.edges[e].a), number(mesh.edges[e].b));
    if (static_cast<std::int32_t>(e) < ghosted.own_edges)
      expected.erase(of_edge);
    else
      CHECK(actual.emplace(of_edge, mesh.edges[e].marker).second);
  }
  CHECK(actual == expected);
}

/// What one rank sends another is what that one receives, in the same order.
void check_neighbors(const IdVector<Rank, GhostedPiece>& all) {
  for (const GhostedPiece& one : all) {
    std::size_t ghosts = 0;
    for (const GhostedPiece::Neighbor& n : one.neighbors) {
      const GhostedPiece& other = all[n.rank];
      const auto back = std::ranges::find(other.neighbors, one.rank, &GhostedPiece::Neighbor::rank);
      REQUIRE(back != other.neighbors.end());
      REQUIRE(n.sent.size() == back->received.size());
      ghosts += n.received.size();
      for (std::size_t k = 0; k < n.sent.size(); ++k) {
        CHECK(n.sent[k] < one.own_triangles);
        CHECK(back->received[k] >= other.own_triangles);
        CHECK(one.triangle_numbers[static_cast<std::size_t>(n.sent[k])] ==
              other.triangle_numbers[static_cast<std::size_t>(back->received[k])]);
      }
    }
    CHECK(ghosts == one.mesh.triangles.size() - static_cast<std::size_t>(one.own_triangles));
  }
}

}  // namespace

TEST_CASE("random domains on random ranks make one mesh") {
  std::size_t shared = 0, empty = 0, not_delaunay = 0;
  const auto cases = static_cast<std::uint64_t>(case_count(60));
  for (std::uint64_t seed = 1; seed <= cases; ++seed) {
    CAPTURE(seed);
    const DistributedCase c = random_distributed_case(seed);
    CAPTURE(oracles::poly_text(c.input));
    MergeFaults faults;
    const Mesh alone =
        merge_pieces(meshes_of(c.pieces(1, IdVector<SubdomainId, Rank>(c.parts.size(), Rank{0}))), faults);
    for (const std::int32_t ranks : {1, 2, 3, 7}) {
      CAPTURE(ranks);
      const auto pieces = c.pieces(ranks, random_owners(c.parts.size(), ranks, seed));
      check_numbers(pieces);
      check_interfaces(pieces);
      Mesh whole = merge_pieces(meshes_of(pieces), faults);
      check_whole(c, pieces, whole);
      whole.ranks = alone.ranks;
      test::check_same_mesh(whole, alone);  // whatever the distribution
      for (const DistributedPiece& piece : pieces) {
        empty += piece.mesh.triangles.empty();
        for (const auto& neighbor : piece.neighbors) shared += neighbor.shared.size();
      }
    }
    CHECK(faults.count == 0);
    not_delaunay += verify(alone, {}).interface_edges_not_delaunay;
  }
  MESSAGE(shared << " shared vertices, " << empty << " empty ranks, " << not_delaunay << " edges not Delaunay");
  CHECK(shared > 100 * cases);
  CHECK(empty > cases / 10);
  CHECK(not_delaunay > 0);
}

TEST_CASE("sleeping subdomains look the same as others") {
  const auto cases = static_cast<std::uint64_t>(case_count(20));
  for (std::uint64_t seed = 1; seed <= cases; ++seed) {
    CAPTURE(seed);
    const DistributedCase c = random_distributed_case(seed);
    IdVector<SubdomainId, DormantMesh> asleep;
    for (const SubdomainMesh& part : c.parts) asleep.emplace_back(part);
    IdVector<Rank, std::unique_ptr<PieceAssembly>> all;
    for (const Rank r : first_ids<Rank>(2))
      all.push_back(std::make_unique<PieceAssembly>(r, 2, c.decomposition, [&, r](const ShowSubdomain& show) {
        for (const SubdomainId i : ids_of(asleep))
          if (Rank{to_int(i) % 2} == r) show(i, asleep[i].wake());
      }));
    exchange_directly(IdVector<Rank, Exchange*>{all.front().get(), all.back().get()});
    const IdVector<Rank, DistributedPiece> pieces{all.front()->piece(c.input), all.back()->piece(c.input)};
    check_numbers(pieces);
    check_interfaces(pieces);
    MergeFaults faults;
    check_whole(c, pieces, merge_pieces(meshes_of(pieces), faults));
  }
}

TEST_CASE("messages may come in any order") {
  std::uint64_t reordered = 0;
  const auto cases = static_cast<std::uint64_t>(case_count(200));
  for (std::uint64_t seed = 1; seed <= cases; ++seed) {
    CAPTURE(seed);
    const DistributedCase c = random_distributed_case(seed % 5 + 1);
    const auto ranks = static_cast<std::int32_t>(2 + seed % 6);
    const IdVector<SubdomainId, Rank> owners = random_owners(c.parts.size(), ranks, seed);
    const auto all = c.assemblies(ranks, owners);
    protocol::AdversarialNetwork network(ranks, protocol::Adversary::from_seed(seed));
    const std::size_t part = seed % 2 == 0 ? ExchangeRunner::kPart : 20 + seed;  // whole, or in many parts
    IdVector<Rank, Exchange*> exchanges;
    for (const auto& one : all) exchanges.push_back(one.get());
    exchange_over(network, exchanges, part);
    const auto expected = c.pieces(ranks, owners);
    for (const Rank r : ids_of(all)) test::check_same_mesh(all[r]->piece(c.input).mesh, expected[r].mesh);
    reordered += network.counters().reordered;
  }
  CHECK(reordered > 0);
}

TEST_CASE("ghosts are the triangles of other ranks at the points of a piece") {
  std::uint64_t reordered = 0;
  std::size_t ghosts = 0, ghost_edges = 0, of_third = 0;
  const auto cases = static_cast<std::uint64_t>(case_count(60));
  for (std::uint64_t seed = 1; seed <= cases; ++seed) {
    CAPTURE(seed);
    const DistributedCase c = random_distributed_case(seed);
    const auto ranks = static_cast<std::int32_t>(1 + seed % 6);
    const auto pieces = c.pieces(ranks, random_owners(c.parts.size(), ranks, seed));
    std::vector<std::unique_ptr<GhostLayer>> layers;
    IdVector<Rank, Exchange*> exchanges;
    for (const DistributedPiece& piece : pieces) {
      layers.push_back(std::make_unique<GhostLayer>(piece));
      exchanges.push_back(layers.back().get());
    }
    protocol::AdversarialNetwork network(ranks, protocol::Adversary::from_seed(seed));
    exchange_over(network, exchanges, seed % 2 == 0 ? ExchangeRunner::kPart : 20 + seed);
    reordered += network.counters().reordered;
    IdVector<Rank, GhostedPiece> all;
    for (const auto& layer : layers) all.push_back(layer->take());

    MergeFaults faults;
    const Mesh whole = merge_pieces(meshes_of(pieces), faults);
    const auto triangles = triangles_of(pieces);
    std::map<std::int64_t, Rank> owners;
    for (const DistributedPiece& piece : pieces)
      for (std::size_t v = 0; v < piece.owners.size(); ++v) owners[piece.mesh.numbers[v]] = piece.owners[v];
    for (const Rank r : ids_of(all)) {
      CAPTURE(to_int(r));
      check_front(pieces[r], all[r]);
      check_ghost_points(all[r], whole, owners);
      check_ghost_triangles(all[r], whole, ring_around(pieces[r], triangles));
      check_ghost_edges(all[r], whole);
      ghosts += all[r].mesh.triangles.size() - pieces[r].mesh.triangles.size();
      ghost_edges += all[r].mesh.edges.size() - pieces[r].mesh.edges.size();
      for (std::size_t v = pieces[r].mesh.points.size(); v < all[r].owners.size(); ++v) {
        std::set<std::int32_t> at;
        for (std::size_t t = 0; t < all[r].mesh.triangles.size(); ++t)
          if (std::ranges::count(all[r].mesh.triangles[t], static_cast<std::int32_t>(v)) > 0)
            at.insert(all[r].mesh.ranks[t]);
        of_third += at.contains(to_int(all[r].owners[v])) ? 0 : 1;
      }
    }
    check_neighbors(all);
  }
  MESSAGE(ghosts << " ghosts, " << ghost_edges << " subsegments of theirs, " << of_third
                 << " points that belong to ranks without a ghost at them");
  CHECK(reordered > 0);
  CHECK(ghosts > 50 * cases);
  CHECK(ghost_edges > 5 * cases);
}
