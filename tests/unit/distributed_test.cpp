#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "base/bytes.hpp"
#include "distributed/write_distributed.hpp"
#include "distributed/write_together.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/generate.hpp"
#include "io/pvtu_format.hpp"
#include "mesh/digest.hpp"
#include "mesh/merge_pieces.hpp"
#include "protocol/adversarial_network.hpp"
#include "support/damage.hpp"
#include "support/distributed_case.hpp"
#include "support/id_literals.hpp"
#include "support/mesh_equality.hpp"
#include "temporary_folder.hpp"
#include "verify/verify.hpp"

using namespace driftmesh;
using namespace driftmesh::testing;
using namespace driftmesh::test;

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

  HeldSubdomains held(std::initializer_list<SubdomainId> ids) {
    std::vector<HeldSubdomain> list;
    for (const SubdomainId i : ids) list.push_back({i, &parts[i]});
    return held_in_memory(list);
  }
};

void talk(const IdVector<Rank, Exchange*>& ranks) {
  exchange_directly(ranks);
}

template <class Run>
std::string message_of(Run run) {
  try {
    run();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

bool mentions(const std::string& text, std::initializer_list<const char*> words) {
  return std::all_of(words.begin(), words.end(),
                     [&](const char* word) { return text.find(word) != std::string::npos; });
}

DistributedCase plate(std::int32_t subdomains) {
  QualityBounds bounds;
  bounds.min_angle = 20;
  bounds.max_area = 0.05;
  return {generate_holes({.columns = 3, .rows = 2}), subdomains, bounds};
}

/// The messages of the exceptions of all ranks when they write, or "".
std::vector<std::string> write_all(const IdVector<Rank, Exchange*>& ranks) {
  protocol::AdversarialNetwork network(static_cast<std::int32_t>(ranks.size()), protocol::Adversary::from_seed(3));
  IdVector<Rank, ExchangeRunner> runners;
  for (const Rank r : ids_of(ranks)) runners.emplace_back(network.transport(r));
  IdVector<Rank, std::string> messages(ranks.size());
  IdVector<Rank, protocol::RankStep> steps;
  for (const Rank r : ids_of(ranks))
    steps.push_back([&, r] {
      try {
        return runners[r].step(*ranks[r]);
      } catch (const Error& error) {
        messages[r] = error.what();
        return protocol::StepResult::kFinished;
      }
    });
  CHECK(network.run(steps).end == protocol::RunEnd::kFinished);
  return messages;
}

std::vector<std::string> files_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

/// The ranks of the plate on three ranks, each about to write its piece.
struct ThreeWriters {
  explicit ThreeWriters(const std::string& path) {
    for (const DistributedPiece& piece : pieces) writers.push_back(std::make_unique<WritePieces>(piece, path));
    for (const auto& writer : writers) exchanges.push_back(writer.get());
  }
  DistributedCase c = plate(9);
  std::vector<DistributedPiece> pieces = c.pieces(3, random_owners(c.parts.size(), 3, 5));
  std::vector<std::unique_ptr<WritePieces>> writers;
  IdVector<Rank, Exchange*> exchanges;
};

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
  const std::string apart = message_of([&] {
    PieceAssembly one(0_rank, 2, squares.d, squares.held({1_sub})), other(1_rank, 2, squares.d, squares.held({0_sub}));
    talk({&one, &other});
  });
  CAPTURE(apart);
  CHECK(mentions(apart, {"root 6", "rank 0 has 1 points", "rank 1 has 2 points"}));
  const std::string together = message_of([&] { PieceAssembly(0_rank, 1, squares.d, squares.held({0_sub, 1_sub})); });
  CAPTURE(together);
  CHECK(mentions(together, {"root 6", "rank 0 has 2 points", "rank 0 has 1 points"}));

  split(squares.parts[1_sub], kSeparator, {3});  // as many, but different ones
  const std::string same_count = message_of([&] {
    PieceAssembly one(0_rank, 2, squares.d, squares.held({1_sub})), other(1_rank, 2, squares.d, squares.held({0_sub}));
    talk({&one, &other});
  });
  CAPTURE(same_count);
  CHECK(mentions(same_count, {"root 6", "2 points on it, not the same"}));
}

TEST_CASE("a subdomain held by no rank or by two is an error that says so") {
  TwoSquares squares;
  const auto on_two_ranks = [&](std::initializer_list<SubdomainId> one, std::initializer_list<SubdomainId> other) {
    return message_of([&] {
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
  CHECK(mentions(message_of([&] { (void)one.piece(two_squares_input()); }), {"point 6", "subdomain 1"}));
}

TEST_CASE("messages that are not part of an exchange are errors that name the sender") {
  const auto send_to_rank_0 = [](const Bytes& bytes) {
    protocol::AdversarialNetwork network(2, protocol::Adversary::from_seed(1));
    TwoSquares squares;
    PieceAssembly assembly(0_rank, 2, squares.d, squares.held({0_sub}));
    ExchangeRunner runner(network.transport(0_rank));
    network.transport(1_rank).send(0_rank, bytes);
    return message_of([&] {
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
  CHECK(send_to_rank_0(message(kMark, 5, {0})) == "no error");        // of a rank that is ahead: it waits
}

TEST_CASE("pieces that are written and read back make the same mesh") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "plate.pvtu";
  ThreeWriters three(path);
  CHECK(write_all(three.exchanges) == std::vector<std::string>(3));
  CHECK(files_in(folder.path()) == std::vector<std::string>{"plate.pvtu", "plate_0.vtu", "plate_1.vtu", "plate_2.vtu"});
  const std::vector<Mesh> read = read_pieces(path);
  REQUIRE(read.size() == 3);
  for (std::size_t k = 0; k < 3; ++k) check_same_mesh(read[k], three.pieces[k].mesh);
  MergeFaults faults;
  check_same_mesh(read_mesh(path), merge_pieces(meshes_of(three.pieces), faults));
}

TEST_CASE("a .pvtu lists the arrays of its pieces, in their order") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "a & b.pvtu";
  ThreeWriters three(path);
  CHECK(write_all(three.exchanges) == std::vector<std::string>(3));
  const std::string whole = file_bytes(path), piece = file_bytes(folder.path() / "a & b_1.vtu");
  // The arrays with types and components, by line, of one file.
  const auto arrays = [](const std::string& text) {
    std::vector<std::string> found;
    std::istringstream lines(text.substr(0, text.find("<AppendedData")));
    for (std::string line; std::getline(lines, line);) {
      const std::size_t type = line.find("DataArray type=");
      if (type == std::string::npos || line.find("connectivity") != std::string::npos ||
          line.find("offsets") != std::string::npos || line.find("types") != std::string::npos)
        continue;
      line = line.substr(type, line.find_first_of("/>", type) - type);
      found.push_back(line.substr(0, line.find(" format=")));
    }
    return found;
  };
  CHECK(arrays(whole) == arrays(piece));
  CHECK(arrays(whole).size() == 7);
  CHECK(whole.find("<Piece Source=\"a &amp; b_2.vtu\"/>") != std::string::npos);
  CHECK(piece.find("GlobalIds=\"global_number\"") != std::string::npos);
}

TEST_CASE("an empty rank writes a piece with the same arrays") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "plate.pvtu";
  const DistributedCase c = plate(2);
  const auto pieces = c.pieces(3, {0_rank, 2_rank});
  std::vector<std::unique_ptr<WritePieces>> writers;
  IdVector<Rank, Exchange*> exchanges;
  for (const DistributedPiece& piece : pieces) writers.push_back(std::make_unique<WritePieces>(piece, path));
  for (const auto& writer : writers) exchanges.push_back(writer.get());
  CHECK(write_all(exchanges) == std::vector<std::string>(3));
  CHECK(read_pieces(path)[1].points.empty());
  CHECK(verify_pieces(read_pieces(path), &c.input, {}).accepted());
  CHECK(file_bytes(folder.path() / "plate_1.vtu").find("Name=\"subdomain\"") != std::string::npos);
}

TEST_CASE("names of markers and regions reach the pieces, their files and the gathered mesh") {
  const TemporaryFolder folder;
  DistributedCase c = plate(9);
  c.input.names = {{{1, "outside"}, {77, "nowhere"}}, {{0.5, "plate & holes"}}};
  const auto pieces = c.pieces(3, random_owners(c.parts.size(), 3, 5));
  for (const DistributedPiece& piece : pieces) CHECK(piece.mesh.names == c.input.names);
  const auto written = [&]<class Writer>(const std::string& path, const Writer& make) {
    std::vector<std::unique_ptr<Exchange>> writers;
    IdVector<Rank, Exchange*> exchanges;
    for (const DistributedPiece& piece : pieces) writers.push_back(make(piece, path));
    for (const auto& writer : writers) exchanges.push_back(writer.get());
    CHECK(write_all(exchanges) == std::vector<std::string>(3));
    return read_mesh(path).names;
  };
  CHECK(written(folder.path() / "plate.h5", [](const DistributedPiece& piece, const std::string& path) {
          return std::make_unique<WriteTogether>(piece, path);
        }) == c.input.names);
  CHECK(written(folder.path() / "plate.pvtu", [](const DistributedPiece& piece, const std::string& path) {
          return std::make_unique<WritePieces>(piece, path);
        }) == c.input.names);
  std::vector<std::unique_ptr<GatherPieces>> gathering;
  IdVector<Rank, Exchange*> exchanges;
  for (const DistributedPiece& piece : pieces) gathering.push_back(std::make_unique<GatherPieces>(piece));
  for (const auto& one : gathering) exchanges.push_back(one.get());
  talk(exchanges);
  CHECK(gathering[0]->whole().names == c.input.names);
}

TEST_CASE("ranks write one .h5 together, whichever holds what, and even if one holds nothing") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "plate.h5";
  const DistributedCase c = plate(9);
  for (const std::int32_t holders : {1, 2, 3}) {  // of three ranks
    const auto pieces = c.pieces(3, random_owners(c.parts.size(), holders, 5));
    std::vector<std::unique_ptr<WriteTogether>> writers;
    IdVector<Rank, Exchange*> exchanges;
    for (const DistributedPiece& piece : pieces) writers.push_back(std::make_unique<WriteTogether>(piece, path));
    for (const auto& writer : writers) exchanges.push_back(writer.get());
    CHECK(write_all(exchanges) == std::vector<std::string>(3));
    CHECK(files_in(folder.path()) == std::vector<std::string>{"plate.h5", "plate.xdmf"});
    MergeFaults faults;
    Mesh whole = merge_pieces(meshes_of(pieces), faults);
    check_same_mesh(read_mesh(path), whole);
  }
}

TEST_CASE("if rank 0 cannot make the .h5, every rank says why") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "none" / "plate.h5";
  const DistributedCase c = plate(9);
  const auto pieces = c.pieces(3, random_owners(c.parts.size(), 3, 5));
  WriteTogether one(pieces[0_rank], path), two(pieces[1_rank], path), three(pieces[2_rank], path);
  for (const std::string& message : write_all({&one, &two, &three})) CHECK(mentions(message, {"rank 0: ", "plate.h5"}));
}

TEST_CASE("if one rank cannot write, no file appears and every rank says why") {
  const TemporaryFolder folder;
  ThreeWriters three(folder.path() / "plate.pvtu");
  std::filesystem::create_directory(folder.path() / "plate_1.vtu");  // where a file should go
  for (const std::string& message : write_all(three.exchanges)) {
    CAPTURE(message);
    CHECK(mentions(message, {"rank 1: ", "plate_1.vtu"}));
  }
  three.exchanges.clear();
  three.writers.clear();
  CHECK(files_in(folder.path()) == std::vector<std::string>{"plate_1.vtu"});
}

TEST_CASE("rank 0 writes the whole mesh, and all ranks learn of a failure") {
  const TemporaryFolder folder;
  const DistributedCase c = plate(9);
  const auto pieces = c.pieces(3, random_owners(c.parts.size(), 3, 5));
  std::vector<GatherPieces> gathers(pieces.begin(), pieces.end());
  CHECK(write_all({&gathers[0], &gathers[1], &gathers[2]}) == std::vector<std::string>(3));
  CHECK(gathers[1].whole().points.empty());
  MergeFaults faults;
  check_same_mesh(gathers[0].whole(), merge_pieces(meshes_of(pieces), faults));

  const auto write = [&](const std::string& name) {
    std::vector<std::unique_ptr<WriteWhole>> writers;
    for (const Rank r : ids_of(pieces))
      writers.push_back(std::make_unique<WriteWhole>(pieces[r], gathers[to_index(r)].whole(), folder.path() / name));
    return write_all({writers[0].get(), writers[1].get(), writers[2].get()});
  };
  for (const char* name : {"plate.vtu", "plate.msh", "plate.ele"}) {
    CAPTURE(name);
    CHECK(write(name) == std::vector<std::string>(3));
    CHECK(mesh_digest(read_mesh(folder.path() / name)) == mesh_digest(gathers[0].whole()));
  }
  CHECK(verify(read_mesh(folder.path() / "plate.msh"), c.input, {}).accepted());
  for (const std::string& message : write("no-such-folder/plate.vtu"))
    CHECK(mentions(message, {"rank 0: ", "no-such"}));
}
