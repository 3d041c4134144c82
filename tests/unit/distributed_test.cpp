#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "base/bytes.hpp"
#include "distributed/census.hpp"
#include "distributed/ghost_layer.hpp"
#include "distributed/mesh_bytes.hpp"
#include "support/adversarial_network.hpp"
#include "support/distributed_case.hpp"
#include "support/error_text.hpp"
#include "support/id_literals.hpp"
#include "support/mesh_equality.hpp"

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

TEST_CASE("attributes of input points stay what they are, whatever those around them are") {
  TwoSquares squares;
  for (SubdomainMesh& part : squares.parts) split(part, kSeparator, {1});
  for (std::size_t infinite = 0; infinite < 4; ++infinite) {
    CAPTURE(infinite);
    Pslg pslg = two_squares_input();
    pslg.attributes_per_point = 2;
    pslg.attributes = {1, 10, 2, 20, 3, 30, 4, 40};
    pslg.attributes[2 * infinite] = INFINITY;
    PieceAssembly one(0_rank, 2, squares.d, squares.held({0_sub})), other(1_rank, 2, squares.d, squares.held({1_sub}));
    talk({&one, &other});
    for (const PieceAssembly* const assembly : {&one, &other}) {
      const DistributedPiece piece = assembly->piece(pslg);
      REQUIRE(piece.mesh.attributes.size() == 2 * piece.mesh.points.size());
      int input_points = 0;
      for (std::size_t v = 0; v < piece.mesh.points.size(); ++v)
        for (std::size_t k = 0; k < pslg.points.size(); ++k)
          if (piece.mesh.points[v] == pslg.points[k]) {
            CHECK(piece.mesh.attributes[2 * v] == pslg.attributes[2 * k]);
            CHECK(piece.mesh.attributes[2 * v + 1] == pslg.attributes[2 * k + 1]);
            ++input_points;
          }
      CHECK(input_points == 2);
    }
  }
}

namespace {

/// Rounds of words: each rank tells some others its number and the round.
class Words final : public Exchange {
 public:
  Words(Rank self, std::int32_t ranks, std::size_t length) : self_(self), ranks_(ranks), length_(length) {}
  [[nodiscard]] int rounds() const override { return 3; }
  [[nodiscard]] std::vector<Mail> send(int round) override {
    std::vector<Mail> mail;
    for (const Rank to : first_ids<Rank>(ranks_))
      if (tells(self_, to, round)) mail.push_back({to, words(self_, round)});
    return mail;
  }
  [[nodiscard]] std::vector<Rank> senders(int round) const override {
    std::vector<Rank> from;
    for (const Rank r : first_ids<Rank>(ranks_))
      if (tells(r, self_, round)) from.push_back(r);
    return from;
  }
  void receive(int round, std::vector<Mail> mail) override {
    std::vector<Rank> from;
    for (const Mail& m : mail) {
      from.push_back(m.rank);
      CHECK(m.bytes == words(m.rank, round));
    }
    CHECK(from == senders(round));
    ++received;
  }
  int received = 0;

 private:
  static bool tells(Rank from, Rank to, int round) { return round == 1 ? to_int(to) == to_int(from) + 1 : from != to; }
  [[nodiscard]] Bytes words(Rank from, int round) const {
    return Bytes(round == 2 ? 0 : length_ + to_index(from), static_cast<std::byte>(16 * round + to_int(from)));
  }
  Rank self_;
  std::int32_t ranks_;
  std::size_t length_;
};

}  // namespace

TEST_CASE("rounds end when all that is due has come, in parts or whole, in any order, again and again") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    for (const std::size_t length : {0, 1, 7, 8, 9, 64}) {
      CAPTURE(seed);
      CAPTURE(length);
      protocol::AdversarialNetwork network(3, protocol::Adversary::from_seed(seed));
      IdVector<Rank, std::unique_ptr<ExchangeRunner>> runners;
      IdVector<Rank, std::unique_ptr<Words>> words;
      IdVector<Rank, protocol::RankStep> steps;
      for (const Rank r : first_ids<Rank>(3)) {
        runners.push_back(std::make_unique<ExchangeRunner>(network.transport(r), 8));
        words.push_back(std::make_unique<Words>(r, 3, length));
        steps.push_back([&, r, times = 0]() mutable {
          const protocol::StepResult result = runners[r]->step(*words[r]);
          if (result != protocol::StepResult::kFinished || ++times == 2) return result;
          return protocol::StepResult::kBusy;
        });
      }
      REQUIRE(network.run(steps).end == protocol::RunEnd::kFinished);
      CHECK(network.in_flight() == 0);
      for (const auto& w : words) CHECK(w->received == 6);
    }
}

TEST_CASE("mail that comes late, twice, or from a rank that is not due is an error that names the sender") {
  // Rank 1 of two says what it likes, in order; rank 0 goes through the rounds of Words.
  const auto told_by_rank_1 = [](const std::vector<std::array<std::uint32_t, 3>>& messages) {
    protocol::Adversary in_order = protocol::Adversary::from_seed(1);
    in_order.fifo = true;
    protocol::AdversarialNetwork network(2, in_order);
    Words words(0_rank, 2, 3);
    ExchangeRunner runner(network.transport(0_rank), 8);
    return error_text([&] {
      for (const auto& [serial, part, parts] : messages) {
        ByteWriter writer;
        for (const std::uint32_t word : {std::uint32_t{0x32584d44}, serial, part, parts}) writer.value(word);
        writer.array(serial == 2 ? Bytes{} : Bytes(4, static_cast<std::byte>(16 * serial + 1)));
        network.transport(1_rank).send(0_rank, writer.take());
        for (int k = 0; k < 50; ++k) (void)runner.step(words);
      }
    });
  };
  // In round 1 nobody tells rank 0 anything: after round 0 it goes on to round 2 by itself.
  CHECK(told_by_rank_1({{0, 0, 1}, {2, 0, 1}}) == "no error");
  CHECK(mentions(told_by_rank_1({{0, 0, 1}, {0, 0, 1}}), {"rank 1", "after its round 0"}));
  CHECK(mentions(told_by_rank_1({{1, 0, 1}, {0, 0, 1}}), {"rank 1", "no message was expected", "round 1"}));
  CHECK(mentions(told_by_rank_1({{0, 0, 2}, {0, 0, 2}}), {"rank 1", "second of round 0"}));
  CHECK(mentions(told_by_rank_1({{0, 0, 2}, {0, 1, 3}}), {"rank 1", "second of round 0"}));
  CHECK(mentions(told_by_rank_1({{0, 2, 2}}), {"rank 1", "part 2 of 2"}));
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

TEST_CASE("a census is of subdomains in order, each with the roots that it was given") {
  TwoSquares squares;
  const auto census = [&](std::vector<SubdomainId> visited, bool swapped) {
    return error_text([&] {
      static_cast<void>(take_census(squares.d, [&](const ShowSubdomain& show) {
        for (const SubdomainId i : visited) show(i, squares.parts[swapped ? SubdomainId{1 - to_int(i)} : i]);
      }));
    });
  };
  CHECK(census({0_sub, 1_sub}, false) == "no error");
  CHECK(mentions(census({1_sub, 0_sub}, false), {"subdomain 0 is visited out of order"}));
  CHECK(mentions(census({1_sub, 1_sub}, false), {"subdomain 1 is visited out of order"}));
  CHECK(mentions(census({0_sub}, true), {"subdomain 0 does not have the roots"}));
  CHECK(mentions(error_text([&] { static_cast<void>(census_of(squares.d, 2_sub, squares.parts[0_sub])); }),
                 {"subdomain 2 is not in the decomposition"}));
}

TEST_CASE("a message has as many parts as it fills") {
  for (const auto& [length, parts] : {std::pair{0, 1}, {1, 1}, {7, 1}, {8, 1}, {9, 2}, {16, 2}, {17, 3}}) {
    CAPTURE(length);
    protocol::AdversarialNetwork network(2, protocol::Adversary::from_seed(1));
    Words words(0_rank, 2, static_cast<std::size_t>(length));
    ExchangeRunner runner(network.transport(0_rank), 8);
    (void)runner.step(words);
    CHECK(std::cmp_equal(network.in_flight(), parts));
  }
}

TEST_CASE("directly, too, mail comes only from those that are due") {
  class Surprised final : public Exchange {
   public:
    explicit Surprised(bool expects) : expects_(expects) {}
    [[nodiscard]] int rounds() const override { return 1; }
    [[nodiscard]] std::vector<Mail> send(int) override { return {{0_rank, Bytes(1)}}; }
    [[nodiscard]] std::vector<Rank> senders(int) const override {
      return expects_ ? std::vector{0_rank} : std::vector<Rank>{};
    }
    void receive(int, std::vector<Mail>) override {}

   private:
    bool expects_;
  };
  for (const bool expects : {true, false}) {
    Surprised one(expects);
    const IdVector<Rank, Exchange*> ranks{&one};
    CHECK(error_text([&] { exchange_directly(ranks); }) ==
          (expects ? "no error" : "rank 0 has messages from other ranks than it expects, in round 0"));
  }
}

TEST_CASE("ghosts without points, and a subdomain of two ranks, are errors that name the sender") {
  const auto piece = [](Rank self, std::int32_t subdomain) {
    DistributedPiece made;
    made.rank = self;
    made.ranks = 2;
    made.mesh.points = {{0, 0}, {1, 0}, {0, 1}};
    made.mesh.triangles = {{0, 1, 2}};
    made.mesh.numbers = {0, 1, 2};
    made.mesh.subdomains = {subdomain};
    made.mesh.ranks = {to_int(self)};
    made.owners.assign(3, 0_rank);
    made.neighbors = {{Rank{1 - to_int(self)}, {0, 1, 2}}};
    return made;
  };
  const auto said = [&](const std::function<void(DistributedPiece&)>& spoil) {
    const DistributedPiece own = piece(0_rank, 0);
    DistributedPiece other = piece(1_rank, 1);
    spoil(other);
    GhostLayer here(own), there(other);
    std::vector<Mail> mail{here.send(0)[0], there.send(0)[0]};
    mail[1].rank = 1_rank;
    return error_text([&] { here.receive(0, mail); });
  };
  CHECK(said([](DistributedPiece&) {}) == "no error");
  CHECK(mentions(said([](DistributedPiece& p) { p.mesh.subdomains = {0}; }),
                 {"rank 1", "has subdomain 0, and so has another one"}));
  // What is sent is what a neighbor made of it: corners that are not there have to be put into its bytes.
  const DistributedPiece own = piece(0_rank, 0), other = piece(1_rank, 1);
  GhostLayer here(own), there(other);
  const std::vector<Mail> mail{here.send(0)[0], {1_rank, there.send(0)[0].bytes}};
  const Bytes good = mesh_to_bytes(other.mesh);
  for (const std::int32_t corner : {3, -1, 1'000'000}) {
    DistributedPiece spoiled = other;
    spoiled.mesh.triangles[0][1] = corner;
    std::vector<Mail> changed = mail;
    const Bytes bad = mesh_to_bytes(spoiled.mesh);
    REQUIRE(bad.size() == good.size());
    const auto at = std::ranges::search(changed[1].bytes, good).begin();
    REQUIRE(at != changed[1].bytes.end());
    std::ranges::copy(bad, at);
    GhostLayer again(own);
    static_cast<void>(again.send(0));
    CHECK(mentions(error_text([&] { again.receive(0, changed); }), {"rank 1", "its triangles have no points"}));
  }
}

TEST_CASE("a mesh is the same once it was sent, with all that it has") {
  Mesh mesh;
  mesh.points = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  mesh.triangles = {{0, 1, 2}, {2, 1, 3}};
  mesh.edges = {{0, 1, 5}, {1, 3, -7}};
  mesh.point_markers = {1, 2, 3, 4};
  mesh.attributes_per_point = 2;
  mesh.attributes = {1, -0.0, 3, 4, 5, 6, 7, 8};
  mesh.attribute_names = {"depth", "friction 50%"};
  mesh.regions = {0.5, 3};
  mesh.numbers = {4, 3, 9, 1'000'000'000'000};
  mesh.subdomains = {6, 7};
  mesh.ranks = {1, 0};
  mesh.names = {{{5, "inlet"}, {-7, "wall"}}, {{0.5, "sand"}}};
  mesh.weirs = {{.type = 24, .points = {0, 1}, .across = {2, 3}, .values = {1, 2, 3, 4, 5, 6}},
                {.type = 3, .points = {1}, .across = {}, .values = {0.25, 1}}};
  mesh.coordinates = "EPSG:32618";
  test::check_same_mesh(mesh_of({2_rank, mesh_to_bytes(mesh)}), mesh);
  test::check_same_mesh(mesh_of({2_rank, mesh_to_bytes({})}), {});
}
