#include <doctest/doctest.h>

#include <map>
#include <set>

#include "mesh/digest.hpp"
#include "mesh/merge_pieces.hpp"
#include "migration/dormant_mesh.hpp"
#include "oracles/meshing.hpp"
#include "property/cases.hpp"
#include "protocol/adversarial_network.hpp"
#include "support/distributed_case.hpp"
#include "support/exchange_over.hpp"
#include "support/mesh_equality.hpp"
#include "verify/report_text.hpp"
#include "verify/verify.hpp"

// Random domains, decomposed, refined, and distributed to ranks at random: the ranks assemble one mesh.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

using Place = std::pair<double, double>;

std::set<Place> places_of(const Mesh& mesh) {
  std::set<Place> places;
  for (const Point& p : mesh.points) places.emplace(p.x, p.y);
  return places;
}

/// Numbers are 0 .. V - 1 over all pieces, one for each position; ascending in each piece, and with an owner.
void check_numbers(const std::vector<DistributedPiece>& pieces) {
  std::map<std::int64_t, Place> place_of_number;
  std::map<Place, std::int64_t> number_of_place;
  std::map<std::int64_t, Rank> owner_of_number;
  std::int64_t triangles = 0;
  for (const DistributedPiece& piece : pieces) {
    const Mesh& mesh = piece.mesh;
    triangles += static_cast<std::int64_t>(mesh.triangles.size());
    REQUIRE(mesh.numbers.size() == mesh.points.size());
    REQUIRE(piece.owners.size() == mesh.points.size());
    CHECK(std::is_sorted(mesh.numbers.begin(), mesh.numbers.end()));
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
      const Place place{mesh.points[v].x, mesh.points[v].y};
      CHECK(place_of_number.emplace(mesh.numbers[v], place).first->second == place);
      CHECK(number_of_place.emplace(place, mesh.numbers[v]).first->second == mesh.numbers[v]);
      CHECK(owner_of_number.emplace(mesh.numbers[v], piece.owners[v]).first->second == piece.owners[v]);
    }
  }
  const auto count = static_cast<std::int64_t>(place_of_number.size());
  CHECK(place_of_number.begin()->first == 0);
  CHECK(place_of_number.rbegin()->first == count - 1);
  for (const DistributedPiece& piece : pieces) {
    CHECK(piece.total_points == count);
    CHECK(piece.total_triangles == triangles);
  }
}

/// The interface lists match a search by coordinates, and the owner of a shared vertex has it.
void check_interfaces(const IdVector<Rank, DistributedPiece>& pieces) {
  IdVector<Rank, std::set<Place>> places;
  for (const DistributedPiece& piece : pieces) places.push_back(places_of(piece.mesh));
  for (const DistributedPiece& piece : pieces) {
    for (std::size_t v = 0; v < piece.mesh.points.size(); ++v)
      CHECK(places[piece.owners[v]].contains({piece.mesh.points[v].x, piece.mesh.points[v].y}));
    std::map<Rank, std::vector<std::int32_t>> expected;
    for (const Rank other : ids_of(pieces)) {
      if (pieces[other].rank == piece.rank) continue;
      for (std::size_t v = 0; v < piece.mesh.points.size(); ++v)
        if (places[other].contains({piece.mesh.points[v].x, piece.mesh.points[v].y}))
          expected[other].push_back(static_cast<std::int32_t>(v));
    }
    std::map<Rank, std::vector<std::int32_t>> actual;
    for (const auto& neighbor : piece.neighbors) actual[neighbor.rank] = neighbor.shared;
    CHECK(actual == expected);
    CHECK(actual.size() == piece.neighbors.size());
  }
}

void check_whole(const DistributedCase& c, const std::vector<DistributedPiece>& pieces, const Mesh& whole) {
  std::uint64_t digest_of_parts = 0, digest_of_pieces = 0;
  for (const SubdomainMesh& part : c.parts) digest_of_parts += mesh_digest(part.mesh);
  for (const DistributedPiece& piece : pieces) digest_of_pieces += mesh_digest(piece.mesh);
  CHECK(digest_of_pieces == digest_of_parts);
  CHECK(mesh_digest(whole) == digest_of_parts);
  VerifyOptions options;
  options.min_angle = c.bounds.min_angle;
  options.max_area = c.bounds.max_area;
  options.region_areas = false;
  const VerifyReport report = verify_pieces(meshes_of(pieces), &c.input, options);
  const std::string text = verdict_text(report, options) + "\n" + report_text(report, options);
  INFO(text);
  CHECK(report.accepted());
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
