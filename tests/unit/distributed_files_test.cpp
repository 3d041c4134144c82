#include <doctest/doctest.h>
#include <hdf5.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "distributed/census.hpp"
#include "distributed/piece_series.hpp"
#include "distributed/write_distributed.hpp"
#include "distributed/write_together.hpp"
#include "driftmesh/generate.hpp"
#include "io/pvtu_format.hpp"
#include "mesh/digest.hpp"
#include "mesh/merge_pieces.hpp"
#include "migration/subdomain.hpp"
#include "support/adversarial_network.hpp"
#include "support/damage.hpp"
#include "support/distributed_case.hpp"
#include "support/error_text.hpp"
#include "support/id_literals.hpp"
#include "support/mesh_equality.hpp"
#include "temporary_folder.hpp"
#include "verify/verify.hpp"

// Files of a distributed mesh: a piece of each rank, or one that all write together.

using namespace driftmesh;
using namespace driftmesh::testing;
using namespace driftmesh::test;

namespace {

DistributedCase plate(std::int32_t subdomains) {
  QualityBounds bounds;
  bounds.min_angle = 20;
  bounds.plain.area = 0.05;
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

/// What a .h5 has as tags of so many triangles, as other programs read them.
std::vector<std::int32_t> cell_tags(const std::string& path, std::size_t triangles) {
  std::vector<std::int32_t> tags(triangles);
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t set = H5Dopen(file, "/tags/cells", H5P_DEFAULT);
  CHECK(H5Dread(set, H5T_NATIVE_INT32, H5S_ALL, H5S_ALL, H5P_DEFAULT, tags.data()) >= 0);
  H5Dclose(set);
  H5Fclose(file);
  return tags;
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
  exchange_directly(exchanges);
  CHECK(gathering[0]->whole().names == c.input.names);
}

TEST_CASE("ranks write one .h5 together, whichever holds what, and even if one holds nothing") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "plate.h5";
  const DistributedCase c = plate(9);
  for (const std::int32_t holders : {1, 2, 3}) {  // out of three ranks
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

TEST_CASE("a line between two ranks is in their .h5 once, and regions are those of all") {
  // A square of two triangles, each on a rank; the segment between them is in both pieces.
  std::vector<DistributedPiece> pieces(2);
  pieces[0].mesh.points = {{0, 0}, {1, 0}, {1, 1}};
  pieces[0].mesh.numbers = {0, 1, 2};
  pieces[0].mesh.edges = {{0, 1, 1}, {1, 2, 2}, {2, 0, 9}};
  pieces[1].mesh.points = {{0, 0}, {1, 1}, {0, 1}};
  pieces[1].mesh.numbers = {0, 2, 3};
  pieces[1].mesh.edges = {{0, 1, 9}, {1, 2, 3}, {2, 0, 4}};
  for (const std::int32_t r : {0, 1}) {
    DistributedPiece& piece = pieces[r];
    piece.rank = Rank{r};
    piece.ranks = 2;
    piece.mesh.triangles = {{0, 1, 2}};
    piece.mesh.subdomains = piece.mesh.ranks = {r};
    piece.mesh.point_markers = {0, 0, 0};
    piece.mesh.regions = {0.25 + r};
    piece.owners = {0_rank, 0_rank, Rank{r}};
    piece.neighbors = {{Rank{1 - r}, r == 0 ? std::vector<std::int32_t>{0, 2} : std::vector<std::int32_t>{0, 1}}};
    piece.has_regions = true;
    piece.total_points = 4;
    piece.total_triangles = 2;
  }
  const TemporaryFolder folder;
  const std::string path = folder.path() / "square.h5";
  WriteTogether one(pieces[0], path), two(pieces[1], path);
  CHECK(write_all({&one, &two}) == std::vector<std::string>(2));
  const Mesh read = read_mesh(path);
  REQUIRE(read.edges.size() == 5);
  std::vector<std::int32_t> markers;
  for (const Mesh::Edge& edge : read.edges) markers.push_back(edge.marker);
  std::ranges::sort(markers);
  CHECK(markers == std::vector<std::int32_t>{1, 2, 3, 4, 9});
  CHECK(read.regions == std::vector<double>{0.25, 1.25});
  const std::vector<std::int32_t> tags = cell_tags(path, 2);
  CHECK(tags[0] != tags[1]);
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
  std::filesystem::create_directory(folder.path() / "plate_1.vtu");  // a file should go there
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

TEST_CASE("a point is a duplicate in all pieces but its owner's") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "plate.pvtu";
  ThreeWriters three(path);
  CHECK(write_all(three.exchanges) == std::vector<std::string>(3));
  std::size_t duplicates = 0;
  for (const DistributedPiece& piece : three.pieces) {
    const std::string bytes = file_bytes(folder.path() / ("plate_" + to_string(piece.rank) + ".vtu"));
    const std::size_t array = bytes.find("Name=\"vtkGhostType\"", bytes.find("<PointData"));
    REQUIRE(array < bytes.find("</PointData>"));
    const std::size_t offset = std::stoul(bytes.substr(bytes.find("offset=\"", array) + 8));
    const std::size_t first = bytes.find('_', bytes.find("<AppendedData")) + 1 + offset + 8;
    for (std::size_t v = 0; v < piece.owners.size(); ++v) {
      REQUIRE(bytes.at(first + v) == (piece.owners[v] == piece.rank ? 0 : 1));
      duplicates += piece.owners[v] == piece.rank ? 0 : 1;
    }
  }
  CHECK(duplicates > 10);
}

TEST_CASE("pieces that do not fit are not one mesh, and all ranks say so") {
  const DistributedCase c = plate(9);
  std::vector<DistributedPiece> pieces = c.pieces(3, random_owners(c.parts.size(), 3, 5));
  const std::int32_t shared = pieces[1].neighbors.front().shared.front();
  pieces[1].mesh.points[to_index(shared)].x += 1e-3;
  std::vector<GatherPieces> gathers(pieces.begin(), pieces.end());
  for (const std::string& message : write_all({&gathers[0], &gathers[1], &gathers[2]}))
    CHECK(mentions(message, {"the pieces of the mesh do not fit together", "coordinates"}));
}

TEST_CASE("a series has a piece for every five million triangles that are expected") {
  for (const auto& [predicted, pieces] : {std::pair{1.0, 1}, {1e6, 2}, {2e6, 4}, {5e6, 10}, {9e6, 10}}) {
    Decomposition decomposition;
    decomposition.subdomains.resize(10);
    for (auto& subdomain : decomposition.subdomains) subdomain.predicted = predicted;
    CHECK(PieceSeries::count(decomposition) == pieces);
  }
}

TEST_CASE("a piece of a series knows of how many it is one") {
  DistributedCase c = plate(4);
  SubdomainContext context{&c.decomposition, c.bounds, true};
  std::map<SubdomainId, Subdomain> subdomains;
  std::vector<SubdomainCensus> census;
  std::vector<SplitPoint<GlobalRootId>> said;
  for (const SubdomainId s : ids_of(c.decomposition.subdomains)) {
    Subdomain& subdomain = subdomains.emplace(s, Subdomain(s, context)).first->second;
    while (subdomain.active()) subdomain.work(10'000, said);
    census.push_back(census_of(c.decomposition, s, subdomain.mesh()));
  }
  REQUIRE(said.empty());  // interfaces were split before
  for (auto& subdomain : c.decomposition.subdomains) subdomain.predicted = 3e6;
  const PieceSeries series(c.decomposition, subdomains, census, c.input);
  REQUIRE(series.size() == 2);
  std::size_t triangles = 0;
  for (const Rank k : first_ids<Rank>(2)) {
    const DistributedPiece piece = series.piece(k);
    CHECK(piece.rank == k);
    CHECK(piece.ranks == 2);
    triangles += piece.mesh.triangles.size();
  }
  std::size_t all = 0;
  for (const auto& one : subdomains) all += one.second.mesh().mesh.live_triangles();
  CHECK(triangles == all);
}

TEST_CASE("what all ranks write is in the coordinates that are asked for") {
  const TemporaryFolder folder;
  const DistributedCase c = plate(2);
  DistributedPiece piece = c.pieces(1, {0_rank, 0_rank})[0_rank];
  for (Point& p : piece.mesh.points) p = {500'000 + 1000 * p.x, 4'000'000 + 1000 * p.y};
  piece.mesh.coordinates = "UTM zone 18N";
  const std::vector<std::string> paths{folder.path() / "as-is.h5", folder.path() / "lonlat.h5"};
  protocol::AdversarialNetwork network(1, protocol::Adversary::from_seed(3));
  ExchangeRunner runner(network.transport(0_rank));
  write_distributed(runner, piece, std::span(paths).first(1), {});
  write_distributed(runner, piece, std::span(paths).last(1), {.crs = "lonlat"});
  const bool same = file_bytes(paths[0]) == file_bytes(paths[1]);
  CHECK(!same);
  const Mesh as_is = read_mesh(paths[0]), back = read_mesh(paths[1]);
  CHECK(as_is.points == piece.mesh.points);
  REQUIRE(back.points.size() == as_is.points.size());
  double largest = 0;  // distance from where it was, once it is back in the plane
  for (std::size_t v = 0; v < back.points.size(); ++v)
    largest = std::max(largest, std::hypot(back.points[v].x - as_is.points[v].x, back.points[v].y - as_is.points[v].y));
  CHECK(largest < 1e-3);
}
