#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <set>
#include <vector>

#include "base/bytes.hpp"
#include "support/adversarial_network.hpp"
#include "support/distributed_case.hpp"
#include "support/error_text.hpp"
#include "support/id_literals.hpp"

// Pieces of a distributed mesh: what ranks number and share, and what they refuse.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

/// Two unit squares side by side, one subdomain each, written by hand.
Decomposition two_squares() {
  Decomposition d;
  d.points = {{0, 0}, {1, 0}, {2, 0}, {0, 1}, {1, 1}, {2, 1}};
  d.origin = {0, kNone, 1, 2, kNone, 3};
  const auto root = [&](std::int32_t from, std::int32_t to, std::int32_t marker, SubdomainId left, SubdomainId right) {
    d.roots.push_back({GlobalPointId{from}, GlobalPointId{to}, marker, kNone, left, right, 0, 0, marker == 0});
  };
  root(0, 1, 5, 0_sub, kNoSubdomain);
  root(1, 2, 5, 1_sub, kNoSubdomain);
  root(0, 3, 8, kNoSubdomain, 0_sub);
  root(2, 5, 6, 1_sub, kNoSubdomain);
  root(3, 4, 7, kNoSubdomain, 0_sub);
  root(4, 5, 7, kNoSubdomain, 1_sub);
  root(1, 4, 0, 0_sub, 1_sub);
  d.subdomains.resize(2);
  list_roots(d);
  d.point_begin = {0, 0, 0};
  return d;
}

Pslg two_squares_input() {
  Pslg pslg;
  pslg.points = {{0, 0}, {2, 0}, {0, 1}, {2, 1}};
  pslg.segments = {{0, 1, 5}, {1, 3, 6}, {3, 2, 7}, {2, 0, 8}};
  return pslg;
}

void split(SubdomainMesh& part, GlobalRootId global, std::initializer_list<dyadic::Path> paths) {
  Refiner refiner(part.mesh, {});
  const auto local = std::find(part.roots.begin(), part.roots.end(), global) - part.roots.begin();
  for (const dyadic::Path path : paths) REQUIRE(refiner.add_split_point(static_cast<RootId>(local), path));
}

constexpr GlobalRootId kSeparator{6};

/// Both squares with the same split points on their separator, and no other points.
struct TwoSquares {
  Decomposition d = two_squares();
  IdVector<SubdomainId, SubdomainMesh> parts{subdomain_triangulation(d, 0_sub), subdomain_triangulation(d, 1_sub)};

  HeldSubdomains held(const std::set<SubdomainId>& ids) {
    return [this, ids](const ShowSubdomain& show) {
      for (const SubdomainId i : ids) show(i, parts[i]);
    };
  }
};

void talk(const IdVector<Rank, Exchange*>& ranks) {
  exchange_directly(ranks);
}

}  // namespace

TEST_CASE("two squares on two ranks: numbers, owners and shared points") {
  TwoSquares squares;
  for (SubdomainMesh& part : squares.parts) split(part, kSeparator, {1, 2});
  PieceAssembly one(0_rank, 2, squares.d, squares.held({1_sub})), other(1_rank, 2, squares.d, squares.held({0_sub}));
  talk({&one, &other});
  const DistributedPiece right = one.piece(two_squares_input()), left = other.piece(two_squares_input());

  // Points of the decomposition keep their numbers; those on the separator follow, from its lower end up.
  CHECK(left.mesh.numbers == std::vector<std::int64_t>{0, 1, 3, 4, 6, 7});
  CHECK(right.mesh.numbers == std::vector<std::int64_t>{1, 2, 4, 5, 6, 7});
  CHECK(left.mesh.points[4] == Point{1, 0.25});
  CHECK(left.mesh.points[5] == Point{1, 0.5});
  // Subdomain 0 is left of the separator and lower at its ends: its rank owns all that is shared.
  CHECK(left.owners == std::vector<Rank>(6, 1_rank));
  CHECK(right.owners == std::vector<Rank>{1_rank, 0_rank, 1_rank, 0_rank, 1_rank, 1_rank});
  REQUIRE(left.neighbors.size() == 1);
  REQUIRE(right.neighbors.size() == 1);
  CHECK(left.neighbors[0].rank == 0_rank);
  CHECK(right.neighbors[0].rank == 1_rank);
  CHECK(left.neighbors[0].shared == std::vector<std::int32_t>{1, 3, 4, 5});
  CHECK(right.neighbors[0].shared == std::vector<std::int32_t>{0, 2, 4, 5});
  CHECK(left.total_points == 8);
  CHECK(left.total_triangles == 8);
  CHECK(left.mesh.subdomains == std::vector<std::int32_t>(4, 0));
  CHECK(left.mesh.ranks == std::vector<std::int32_t>(4, 1));
  // The separator is no subsegment of the input.
  CHECK(left.mesh.edges == std::vector<Mesh::Edge>{{0, 1, 5}, {0, 2, 8}, {2, 3, 7}});
  CHECK(left.mesh.point_markers == std::vector<std::int32_t>{5, 5, 8, 7, 0, 0});
}

TEST_CASE("sides of a root with different points are an error that names it and both ranks") {
  TwoSquares squares;
  split(squares.parts[0_sub], kSeparator, {1, 2});
  split(squares.parts[1_sub], kSeparator, {1});
  const std::string apart = error_text([&] {
    PieceAssembly one(0_rank, 2, squares.d, squares.held({1_sub})), other(1_rank, 2, squares.d, squares.held({0_sub}));
    talk({&one, &other});
  });
  CAPTURE(apart);
  CHECK(mentions(apart, {"root 6", "rank 0 has 1 points", "rank 1 has 2 points"}));
  const std::string together = error_text([&] { PieceAssembly(0_rank, 1, squares.d, squares.held({0_sub, 1_sub})); });
  CAPTURE(together);
  CHECK(mentions(together, {"root 6", "rank 0 has 2 points", "rank 0 has 1 points"}));

  split(squares.parts[1_sub], kSeparator, {3});  // as many, but different ones
  const std::string same_count = error_text([&] {
    PieceAssembly one(0_rank, 2, squares.d, squares.held({1_sub})), other(1_rank, 2, squares.d, squares.held({0_sub}));
    talk({&one, &other});
  });
  CAPTURE(same_count);
  CHECK(mentions(same_count, {"root 6", "2 points on it, not the same"}));
}

TEST_CASE("a subdomain held by no rank or by two is an error that says so") {
  TwoSquares squares;
  const auto on_two_ranks = [&](std::initializer_list<SubdomainId> one, std::initializer_list<SubdomainId> other) {
    return error_text([&] {
      PieceAssembly a(0_rank, 2, squares.d, squares.held(one)), b(1_rank, 2, squares.d, squares.held(other));
      talk({&a, &b});
    });
  };
  CHECK(mentions(on_two_ranks({}, {1_sub}), {"subdomain 0 is held by no rank"}));
  CHECK(mentions(on_two_ranks({0_sub}, {}), {"subdomain 1 is held by no rank"}));
  CHECK(mentions(on_two_ranks({0_sub, 1_sub}, {1_sub}), {"subdomain 1 is held by ranks 0 and 1"}));
  CHECK(mentions(on_two_ranks({0_sub}, {0_sub, 1_sub}), {"subdomain 0 is held by ranks 0 and 1"}));
}

TEST_CASE("a coordinate that differs in its last bit between subdomains of a rank is an error") {
  TwoSquares squares;
  for (SubdomainMesh& part : squares.parts) split(part, kSeparator, {1});
  Point& last = squares.parts[1_sub].mesh.points.end()[-1];
  REQUIRE(last == Point{1, 0.5});
  last.y = std::nextafter(last.y, 1);
  PieceAssembly one(0_rank, 1, squares.d, squares.held({0_sub, 1_sub}));
  talk({&one});
  CHECK(mentions(error_text([&] { (void)one.piece(two_squares_input()); }), {"point 6", "subdomain 1"}));
}

TEST_CASE("messages that are not part of an exchange are errors that name the sender") {
  const auto send_to_rank_0 = [](const Bytes& bytes) {
    protocol::AdversarialNetwork network(2, protocol::Adversary::from_seed(1));
    TwoSquares squares;
    PieceAssembly assembly(0_rank, 2, squares.d, squares.held({0_sub}));
    ExchangeRunner runner(network.transport(0_rank));
    network.transport(1_rank).send(0_rank, bytes);
    return error_text([&] {
      for (int k = 0; k < 100; ++k) (void)runner.step(assembly);
    });
  };
  const auto message = [](std::uint32_t mark, std::uint32_t round, std::vector<std::uint32_t> content,
                          std::uint32_t part = 0, std::uint32_t parts = 1) {
    ByteWriter inner, outer;
    for (const std::uint32_t word : content) inner.value(word);
    outer.value(mark);
    outer.value(round);
    outer.value(part);
    outer.value(parts);
    outer.array(inner.take());
    return outer.take();
  };
  constexpr std::uint32_t kMark = 0x32584d44;
  CHECK(send_to_rank_0(message(kMark, 0, {})).find("message from rank 1: it ends too early") == 0);
  CHECK(send_to_rank_0(message(kMark, 0, {4'000'000'000})).find("message from rank 1: it ends too early") == 0);
  CHECK(send_to_rank_0(message(kMark, 0, {0, 7})).find("message from rank 1: it goes on after its end") == 0);
  CHECK(send_to_rank_0(message(7, 0, {0})).find("message from rank 1: it is not part of an exchange") == 0);
  CHECK(send_to_rank_0({}).find("message from rank 1: it ends too early") == 0);
  CHECK(send_to_rank_0(message(kMark, 0, {0}, 3, 3)).find("message from rank 1: it is part 3 of 3") == 0);
  CHECK(send_to_rank_0(message(kMark, 0, {0}, 0, 0xFFFFFFFF)).find("message from rank 1: it is part 0 of") == 0);
  CHECK(send_to_rank_0(message(kMark, 0, {0}, 1, 3)) == "no error");  // the others may come
  CHECK(send_to_rank_0(message(kMark, 5, {0})) == "no error");        // from a rank that is ahead: it waits
}
