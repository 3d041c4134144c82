#include <doctest/doctest.h>
#include <mpi.h>

#include <filesystem>
#include <string>

#include "api/driftmesh.hpp"
#include "decompose/decompose.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/generate.hpp"
#include "driftmesh/size_field.hpp"
#include "io/mesh_file.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "mesh/digest.hpp"
#include "temporary_folder.hpp"
#include "verify/verify.hpp"

// What a solver calls, on real ranks.

using namespace driftmesh;

namespace {

int world() {
  return MPI_Comm_c2f(MPI_COMM_WORLD);
}

std::uint64_t sum_over_ranks(std::uint64_t value) {
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_UINT64_T, MPI_SUM, MPI_COMM_WORLD);
  return value;
}

/// The folder that rank 0 has made, on all ranks.
std::string shared_path(const TemporaryFolder& folder, const std::string& name) {
  std::string path = (folder.path() / name).string();
  path.resize(200);
  MPI_Bcast(path.data(), 200, MPI_CHAR, 0, MPI_COMM_WORLD);
  return path.c_str();
}

/// What the call throws, if it is the same on all ranks.
template <class Call>
std::string common_error(Call call) {
  std::string said = "nothing";
  try {
    call();
  } catch (const Error& error) {
    said = error.what();
  }
  std::string of_first = said;
  of_first.resize(1000);
  MPI_Bcast(of_first.data(), 1000, MPI_CHAR, 0, MPI_COMM_WORLD);
  CHECK(said == of_first.c_str());
  return said;
}

class Halving final : public SizeField {
 public:
  [[nodiscard]] double edge_length(const Point& p) const override { return p.x < 1 ? 0.1 : 0.05; }
};

Decomposition decompose_hole(int subdomains) {
  Triangulation mesh = triangulate(generate_rectangle_hole({}));
  prepare_corners(mesh);
  DecomposeOptions options;
  options.subdomains = subdomains;
  return decompose(mesh, options);
}

}  // namespace

TEST_CASE("pieces of all ranks are one mesh, whichever way they are made") {
  const TemporaryFolder folder;
  const Pslg input = generate_rectangle_hole({});
  const Halving halving;
  DistributedOptions options;
  options.min_angle = 25;
  for (const bool given : {false, true})
    for (const SizeField* size : {static_cast<const SizeField*>(nullptr), static_cast<const SizeField*>(&halving)}) {
      options.size = size;
      options.max_area = size != nullptr ? 0 : 0.002;
      options.presplit = given ? "off" : "auto";
      options.balance = given ? "stealing" : "none";
      const DistributedPiece piece = given ? mesh_distributed(world(), input, decompose_hole(17), options)
                                           : mesh_distributed(world(), input, options);
      const std::uint64_t digest = sum_over_ranks(mesh_digest(piece.mesh));
      for (const char* name : {"mesh.pvtu", "mesh.msh"}) {
        const std::string path = shared_path(folder, name);
        write_distributed(world(), piece, path);
        if (piece.rank == Rank{0}) {
          const Mesh whole = read_mesh(path);
          CHECK(mesh_digest(whole) == digest);
          VerifyOptions verify_options;
          verify_options.min_angle = 25;
          verify_options.max_area = options.max_area;
          verify_options.size = size;
          CHECK(verify(whole, input, verify_options).accepted());
          CHECK(static_cast<std::int64_t>(whole.points.size()) == piece.total_points);
        }
        MPI_Barrier(MPI_COMM_WORLD);
      }
    }
}

TEST_CASE("only the input of rank 0 counts") {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  DistributedOptions options;
  options.max_area = 0.01;
  const DistributedPiece piece = mesh_distributed(world(), rank == 0 ? generate_rectangle_hole({}) : Pslg(), options);
  CHECK(piece.total_triangles > 200);
}

TEST_CASE("some of the ranks can make a mesh for themselves") {
  int rank = 0, ranks = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  MPI_Comm half = MPI_COMM_NULL;
  MPI_Comm_split(MPI_COMM_WORLD, rank % 2, -rank, &half);
  DistributedOptions options;
  options.max_area = rank % 2 == 0 ? 0.01 : 0.002;
  const DistributedPiece piece = mesh_distributed(MPI_Comm_c2f(half), generate_rectangle_hole({}), options);
  int half_ranks = 0;
  MPI_Comm_size(half, &half_ranks);
  CHECK(piece.ranks == half_ranks);
  CHECK((piece.total_triangles < 800) == (rank % 2 == 0));
  MPI_Comm_free(&half);
}

TEST_CASE("what allows no mesh is thrown on all ranks alike") {
  const Pslg input = generate_rectangle_hole({});
  DistributedOptions options;
  options.min_angle = 50;
  CHECK(common_error([&] { (void)mesh_distributed(world(), input, options); }).find("angle") != std::string::npos);
  options.subdomains = 8;
  CHECK(common_error([&] { (void)mesh_distributed(world(), input, options); }).find("angle") != std::string::npos);
  options = {};
  options.mapping = "by hand";
  CHECK(common_error([&] { (void)mesh_distributed(world(), input, options); }).find("by hand") != std::string::npos);
  options = {};
  options.balance = "by hand";
  CHECK(common_error([&] { (void)mesh_distributed(world(), input, options); }).find("by hand") != std::string::npos);
  CHECK(common_error([&] { (void)mesh_distributed(world(), Pslg(), {}); }) != "nothing");
  const Pslg other = generate_rectangle_hole({.sides = 7});
  CHECK(common_error([&] { (void)mesh_distributed(world(), other, decompose_hole(4), {}); }).find("decomposition") !=
        std::string::npos);
}

TEST_CASE("a file that cannot be written is an error on all ranks") {
  const TemporaryFolder folder;
  DistributedOptions options;
  options.max_area = 0.01;
  const DistributedPiece piece = mesh_distributed(world(), generate_rectangle_hole({}), options);
  for (const char* name : {"no-such-folder/mesh.pvtu", "no-such-folder/mesh.vtu", "mesh.unknown"}) {
    const std::string path = shared_path(folder, name);
    const std::string said = common_error([&] { write_distributed(world(), piece, path); });
    CAPTURE(said);
    CHECK(said.starts_with("rank 0: ") == (std::string(name) != "mesh.unknown"));  // that, every rank sees by itself
    CHECK(said.find(std::string(name).starts_with("no") ? "no-such-folder/mesh" : name) != std::string::npos);
  }
}
