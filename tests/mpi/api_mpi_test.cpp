#include <doctest/doctest.h>
#include <mpi.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <new>
#include <numbers>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "decompose/decompose.hpp"
#include "decompose/presplit.hpp"
#include "driftmesh/decomposition.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/files.hpp"
#include "driftmesh/generate.hpp"
#include "driftmesh/mpi/distributed.hpp"
#include "driftmesh/policy.hpp"
#include "driftmesh/size_field.hpp"
#include "job/mpi/mpi_team.hpp"
#include "job/same_on_ranks.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "mesh/digest.hpp"
#include "mpi/on_all_ranks.hpp"
#include "temporary_folder.hpp"
#include "verify/verify.hpp"

// The library's functions for solvers, on real ranks.

using namespace driftmesh;
using namespace driftmesh::mpi_test;

namespace {

std::uint64_t sum_over_ranks(std::uint64_t value) {
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_UINT64_T, MPI_SUM, MPI_COMM_WORLD);
  return value;
}

class Constant final : public SizeField {
 public:
  explicit Constant(double length) : length_(length) {}
  [[nodiscard]] double edge_length(const Point&) const override { return length_; }

 private:
  double length_;
};

class Halving final : public SizeField {
 public:
  [[nodiscard]] double edge_length(const Point& p) const override { return p.x < 1 ? 0.1 : 0.05; }
};

}  // namespace

TEST_CASE("the pieces of all ranks make one mesh, whatever the options") {
  const TemporaryFolder folder;
  const Pslg input = generate_rectangle_hole({});
  const Halving halving;
  for (const bool given : {false, true})
    for (const SizeField* size : {static_cast<const SizeField*>(nullptr), static_cast<const SizeField*>(&halving)}) {
      MeshOptions options{.min_angle = 25, .max_area = size != nullptr ? 0 : 0.002};
      if (size != nullptr) options.size = std::ref(*size);
      options.subdomains.presplit = given ? Presplit::kOff : Presplit::kAuto;
      options.balance.policy = given ? "stealing" : "none";
      if (given) options.subdomains.given = cut_domain(input, {.subdomains = {.count = 17}});
      const DistributedPiece piece = mesh_distributed(MPI_COMM_WORLD, input, options);
      const std::uint64_t digest = sum_over_ranks(mesh_digest(piece.mesh));
      for (const char* name : {"mesh.pvtu", "mesh.msh"}) {
        const std::string path = shared_path(folder, name);
        write_distributed(MPI_COMM_WORLD, piece, path);
        if (piece.rank == Rank{0}) {
          const Mesh whole = read_mesh(path);
          CHECK(mesh_digest(whole) == digest);
          VerifyOptions verify_options;
          verify_options.min_angle = 25;
          verify_options.plain.area = options.max_area;
          verify_options.size = size;
          CHECK(verify(whole, input, verify_options).accepted());
          CHECK(static_cast<std::int64_t>(whole.points.size()) == piece.total_points);
        }
        MPI_Barrier(MPI_COMM_WORLD);
      }
    }
}

TEST_CASE("only the input of rank 0 counts") {
  const Pslg input = own_rank() == 0 ? generate_rectangle_hole({}) : Pslg();
  const DistributedPiece piece = mesh_distributed(MPI_COMM_WORLD, input, {.max_area = 0.01});
  CHECK(piece.total_triangles > 200);
}

TEST_CASE("a subset of the ranks can make a mesh of its own") {
  int rank = 0, ranks = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  MPI_Comm half = MPI_COMM_NULL;
  MPI_Comm_split(MPI_COMM_WORLD, rank % 2, -rank, &half);
  const DistributedPiece piece =
      mesh_distributed(half, generate_rectangle_hole({}), {.max_area = rank % 2 == 0 ? 0.01 : 0.002});
  int half_ranks = 0;
  MPI_Comm_size(half, &half_ranks);
  CHECK(piece.ranks == half_ranks);
  CHECK((piece.total_triangles < 800) == (rank % 2 == 0));
  MPI_Comm_free(&half);
}

TEST_CASE("errors in the input are thrown on all ranks") {
  const Pslg input = generate_rectangle_hole({});
  const auto error_with = [&](const MeshOptions& options) {
    return common_error([&] { (void)mesh_distributed(MPI_COMM_WORLD, input, options); });
  };
  CHECK(error_with({.min_angle = 50}).starts_with("MeshOptions::min_angle "));
  CHECK(error_with({.min_angle = 50, .subdomains = {.count = 8}}).starts_with("MeshOptions::min_angle "));
  CHECK(error_with({.balance = {.policy = "by hand"}}).starts_with("MeshOptions::balance.policy "));
  CHECK(error_with({.balance = {.policy = "zoltan", .parameters = {{"methd", "rcb"}}}}).find("'method'") !=
        std::string::npos);
  CHECK(error_with({.ranks = {.speeds = {1, 2, 3, 4, 5, 6}}}).starts_with("MeshOptions::ranks.speeds "));
  CHECK(common_error([&] { (void)mesh_distributed(MPI_COMM_WORLD, Pslg(), {}); }) != "nothing");
  MeshOptions of_other;
  of_other.subdomains.given = cut_domain(generate_rectangle_hole({.sides = 7}), {.subdomains = {.count = 4}});
  CHECK(error_with(of_other).find("decomposition") != std::string::npos);
  // A decomposition is given on rank 0 alone.
  MeshOptions of_leader{.subdomains = {.count = 8}};
  if (own_rank() == 0) of_leader.subdomains.given = cut_domain(input, {.subdomains = {.count = 8}});
  CHECK(error_with(of_leader).starts_with("MeshOptions::subdomains.count cannot be combined with a given"));
}

TEST_CASE("who is strict gets no mesh that does not allow the time step") {
  const TemporaryFolder folder;
  const std::string depths = shared_path(folder, "depth.asc");
  if (own_rank() == 0)
    std::ofstream(depths) << "ncols 2\nnrows 2\nxllcorner -50\nyllcorner -50\ncellsize 50\n9 9\n9 9\n";
  MPI_Barrier(MPI_COMM_WORLD);
  MeshOptions options{.subdomains = {.count = 4}};
  options.rasters = {{"depth", depths}};
  options.depth = "depth";
  options.courant.step = 5;  // 47 m of a wave, ten times the domain
  const Pslg input = generate_rectangle_hole({});
  CHECK(mesh_distributed(MPI_COMM_WORLD, input, options).total_triangles > 0);
  options.strict = true;
  const std::string said = common_error([&] { (void)mesh_distributed(MPI_COMM_WORLD, input, options); });
  CHECK(said.find("the time step of 5 s is too long for ") != std::string::npos);
}

TEST_CASE("a failure on one rank ends the work of all, which can then continue with something else") {
  const Pslg input = generate_rectangle_hole({});
  int ranks = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  const int guilty = ranks - 1;
  const std::string who = ranks == 1 ? "" : "rank " + std::to_string(guilty) + ": ";
  MeshOptions options{.max_area = 1e-5, .subdomains = {.count = 40}};
  const auto make = [&] { (void)mesh_distributed(MPI_COMM_WORLD, input, options); };
  for (const char* policy : {"none", "stealing", "zoltan"}) {
    options.balance.policy = policy;
    options.progress = [&](const Progress& progress) { return own_rank() != guilty || progress.triangles < 1000; };
    CHECK(common_error(make) == who + "cancelled by MeshOptions::progress");
    CHECK_THROWS_AS(make(), Cancelled);

    options.progress = [&](const Progress& progress) {
      if (own_rank() == guilty && progress.triangles > 1000) throw Error("the caller's own");
      return true;
    };
    CHECK(common_error(make) == who + "the caller's own");
    options.progress = {};
  }
  options.size = [&](const Point&) -> double {
    if (own_rank() == guilty) throw FileError("no data");
    return 0.01;
  };
  if (ranks > 1) CHECK_THROWS_AS(make(), FileError);
  options.size = [&](const Point&) -> double {
    if (own_rank() == guilty) throw std::bad_alloc();
    return 0.01;
  };
  if (ranks > 1) {
    CHECK_THROWS_AS(make(), LimitError);
    CHECK(common_error(make).find("MeshOptions::max_memory") != std::string::npos);
  }
  options.size = {};
  if (ranks > 1) {
    options.max_area = 2e-6;
    options.balance = {.look = 1e-4, .gap = 0, .gain = 0};
    // Ranks that happen to be in balance to the end need no plan.
    options.progress = [&](const Progress&) {
      if (own_rank() != 0) std::this_thread::sleep_for(std::chrono::milliseconds(20));
      return true;
    };
    options.balance.own = balancer::leader_policy(
        [](const balancer::LoadSnapshot&) -> std::vector<balancer::Move> { throw InputError("no plan today"); });
    CHECK(common_error(make) == "rank 0: no plan today");
    CHECK_THROWS_AS(make(), InputError);
    options.balance = {};
    options.progress = {};
    options.max_area = 1e-5;
  }
  options.max_triangles = 1000;
  CHECK(common_error(make).find("MeshOptions::max_triangles") != std::string::npos);
  CHECK_THROWS_AS(make(), LimitError);
  CHECK(mesh_distributed(MPI_COMM_WORLD, input, {.max_area = 0.01}).total_triangles > 200);
}

TEST_CASE("a callable that only some ranks have is an error on all") {
  int ranks = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  if (ranks == 1) return;
  const auto error_with = [&](const MeshOptions& options) {
    return common_error([&] { (void)mesh_distributed(MPI_COMM_WORLD, generate_rectangle_hole({}), options); });
  };
  for (const int one : {0, ranks - 1}) {
    MeshOptions options;
    if (own_rank() == one) options.size = [](const Point& p) { return p.x < 1 ? 0.1 : 0.05; };
    CHECK(error_with(options).starts_with("MeshOptions::size differs between ranks: "));
    options.size = {};
    if (own_rank() == one)
      options.balance.own = balancer::leader_policy([](const auto&) { return std::vector<balancer::Move>(); });
    CHECK(error_with(options).starts_with("MeshOptions::balance.own differs between ranks: "));
  }
}

TEST_CASE("an option that differs on any rank is an error on all, before it is looked at") {
  const int ranks = rank_count();
  if (ranks == 1) return;
  using Change = std::function<void(MeshOptions&)>;
  const std::vector<std::pair<std::string, Change>> changes{
      {"min_angle", [](MeshOptions& o) { o.min_angle = 50; }},
      {"min_angle", [](MeshOptions& o) { o.min_angle = std::nextafter(o.min_angle, 0.0); }},
      {"max_area", [](MeshOptions& o) { o.max_area = -1; }},
      {"triangles", [](MeshOptions& o) { o.triangles = 1000; }},
      {"size_resolution", [](MeshOptions& o) { o.size_resolution = 100; }},
      {"max_triangles", [](MeshOptions& o) { o.max_triangles = 1; }},
      {"strict", [](MeshOptions& o) { o.strict = true; }},
      {"subdomains.count", [](MeshOptions& o) { o.subdomains.count = 7; }},
      {"subdomains.seed", [](MeshOptions& o) { o.subdomains.seed = 7; }},
      {"subdomains.presplit", [](MeshOptions& o) { o.subdomains.presplit = Presplit::kOff; }},
      {"subdomains.sleep", [](MeshOptions& o) { o.subdomains.sleep = true; }},
      {"ranks.speeds",
       [](MeshOptions& o) {
         o.ranks.speeds = {1, 2, 3, 4, 5};
       }},
      {"balance.policy", [](MeshOptions& o) { o.balance.policy = "by hand"; }},
      {"balance.parameters", [](MeshOptions& o) { o.balance.parameters["methd"] = "rcb"; }},
      {"balance.gap", [](MeshOptions& o) { o.balance.gap = -3; }},
  };
  for (const auto& [name, change] : changes) {
    CAPTURE(name);
    for (const int one : {0, ranks - 1}) {
      MeshOptions options{.max_area = 0.01};
      if (own_rank() == one) change(options);
      const std::string said =
          common_error([&] { (void)mesh_distributed(MPI_COMM_WORLD, generate_rectangle_hole({}), options); });
      CHECK(said.starts_with("MeshOptions::" + name + " differs between ranks: "));
      CHECK(said.find(" on rank " + std::to_string(one == 0 ? 1 : one)) != std::string::npos);
      CHECK(said.find('\n') == std::string::npos);
    }
  }
  const DistributedPiece piece = mesh_distributed(MPI_COMM_WORLD, generate_rectangle_hole({}), {.max_area = 0.01});
  CHECK(common_error([&] {
          write_distributed(MPI_COMM_WORLD, piece, own_rank() == 0 ? "mesh.vtu" : "mesh.pvtu");
        }).starts_with("the path differs between ranks: mesh.vtu on rank 0, mesh.pvtu on rank 1"));
}

TEST_CASE("communicators without a group of ranks are errors, and MPI goes on") {
  const Pslg input = generate_rectangle_hole({});
  const DistributedPiece piece = mesh_distributed(MPI_COMM_WORLD, input, {.max_area = 0.01});
  const auto errors_on = [&](MPI_Comm communicator) {
    return std::vector{common_error([&] { (void)mesh_distributed(communicator, input, {}); }),
                       common_error([&] { (void)add_ghost_layer(communicator, piece); }),
                       common_error([&] { write_distributed(communicator, piece, "mesh.vtu"); })};
  };
  for (const std::string& said : errors_on(MPI_COMM_NULL)) CHECK(said.starts_with("the communicator is MPI_COMM_NULL"));
  if (rank_count() == 1) return;
  MPI_Comm half = MPI_COMM_NULL, between = MPI_COMM_NULL;
  MPI_Comm_split(MPI_COMM_WORLD, own_rank() % 2, 0, &half);
  MPI_Intercomm_create(half, 0, MPI_COMM_WORLD, 1 - own_rank() % 2, 0, &between);
  for (const std::string& said : errors_on(between))
    CHECK(said.starts_with("the communicator is an intercommunicator"));
  MPI_Comm_free(&between);
  MPI_Comm_free(&half);
}

TEST_CASE("size functions that differ between ranks are an error on all that names a point and both values") {
  const int ranks = rank_count();
  if (ranks == 1) return;
  for (const Presplit presplit : {Presplit::kAuto, Presplit::kOff})
    for (const int one : {0, ranks - 1}) {
      MeshOptions options{.subdomains = {.presplit = presplit}};
      options.size = [&](const Point&) { return own_rank() == one ? 0.05 : 0.0625; };
      const std::string said =
          common_error([&] { (void)mesh_distributed(MPI_COMM_WORLD, generate_rectangle_hole({}), options); });
      CHECK(said.starts_with("the size field differs between ranks: at ("));
      CHECK(said.find(one == 0 ? "it is 0.05 on rank 0 and 0.0625 on rank 1; "
                               : "it is 0.0625 on rank 0 and 0.05 on rank " + std::to_string(one) + "; ") !=
            std::string::npos);
    }
}

TEST_CASE("each interface is presplit as the owner of its left side says, whatever sizes others have") {
  job::MpiTeam team(MPI_Comm_c2f(MPI_COMM_WORLD));
  Triangulation mesh = triangulate(generate_rectangle_hole({}));
  prepare_corners(mesh);
  DecomposeOptions cutting;
  cutting.subdomains = 12;
  RunPlan plan;
  plan.decomposition = decompose(mesh, cutting);
  for (const SubdomainId s : ids_of(plan.decomposition.subdomains))
    plan.owners.push_back(Rank{to_int(s) % team.ranks()});
  const auto size_of = [](Rank r) { return Constant(0.1 / (1 + to_int(r))); };
  const Constant own = size_of(team.rank());
  plan.bounds.size = &own;
  const PresplitPaths shared = job::share_presplit(team, plan);
  const std::size_t ranks = to_index(team.ranks());
  team.close();
  std::set<Rank> deciding;
  for (const GlobalRootId r : ids_of(plan.decomposition.roots)) {
    const Decomposition::Root& root = plan.decomposition.roots[r];
    CHECK(shared.contains(r) == root.is_interface());
    if (!root.is_interface()) continue;
    const Rank owner = plan.owners[root.left];
    const Constant size = size_of(owner);
    QualityBounds bounds = plan.bounds;
    bounds.size = &size;
    CHECK(shared.at(r) == presplit_paths(plan.decomposition, r, bounds));
    deciding.insert(owner);
  }
  CHECK(deciding.size() == ranks);
}

TEST_CASE("progress is reported on every rank") {
  std::int64_t most = 0;
  MeshOptions options{.max_area = 1e-5, .subdomains = {.count = 20}};
  options.progress = [&](const Progress& progress) {
    most = std::max(most, progress.triangles);
    return true;
  };
  const DistributedPiece piece = mesh_distributed(MPI_COMM_WORLD, generate_rectangle_hole({}), options);
  CHECK(most == static_cast<std::int64_t>(piece.mesh.triangles.size()));
}

TEST_CASE("a policy of the caller's own moves subdomains") {
  int ranks = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  if (ranks == 1) return;
  // Moves everything to the last rank, whatever the cost.
  MeshOptions options{.max_area = 2e-6, .subdomains = {.count = 60}, .balance = {.look = 1e-4, .gap = 0, .gain = 0}};
  options.balance.own = balancer::leader_policy([](const balancer::LoadSnapshot& load) {
    std::vector<balancer::Move> moves;
    const Rank last = static_cast<Rank>(load.ranks.size() - 1);
    for (const balancer::SubdomainLoad& s : load.subdomains)
      if (s.owner != last) moves.push_back({s.id, last});
    return moves;
  });
  int asked = 0;
  const auto plan = options.balance.own;
  options.balance.own = balancer::leader_policy([&, plan](const balancer::LoadSnapshot& load) {
    ++asked;
    return plan->plan(load, Rank{0});
  });
  // On a busy machine rank 0 may have ended its work before it knows of the others.
  for (int attempt = 0; attempt < 50 && asked == 0; ++attempt) {
    const DistributedPiece piece = mesh_distributed(MPI_COMM_WORLD, generate_rectangle_hole({}), options);
    REQUIRE(piece.total_triangles > 100000);
    MPI_Bcast(&asked, 1, MPI_INT, 0, MPI_COMM_WORLD);
  }
  CHECK(asked > 0);
  options.balance.policy = "greedy";
  CHECK(common_error([&] {
          (void)mesh_distributed(MPI_COMM_WORLD, generate_rectangle_hole({}), options);
        }).starts_with("MeshOptions::balance.own "));
}

TEST_CASE("a file that cannot be written is an error on all ranks") {
  const TemporaryFolder folder;
  const DistributedPiece piece = mesh_distributed(MPI_COMM_WORLD, generate_rectangle_hole({}), {.max_area = 0.01});
  for (const char* name : {"no-such-folder/mesh.pvtu", "no-such-folder/mesh.vtu", "mesh.unknown"}) {
    const std::string path = shared_path(folder, name);
    const std::string said = common_error([&] { write_distributed(MPI_COMM_WORLD, piece, path); });
    CAPTURE(said);
    if (std::string(name) != "mesh.unknown") CHECK_THROWS_AS(write_distributed(MPI_COMM_WORLD, piece, path), FileError);
    CHECK(said.starts_with("rank 0: ") == (std::string(name) != "mesh.unknown"));  // all ranks see wrong formats
    CHECK(said.find(std::string(name).starts_with("no") ? "no-such-folder/mesh" : name) != std::string::npos);
  }
}

TEST_CASE("ghosts have the values that their owners send") {
  const DistributedPiece piece =
      mesh_distributed(MPI_COMM_WORLD, generate_rectangle_hole({}), {.max_area = 0.002, .subdomains = {.count = 13}});
  const GhostedPiece ghosted = add_ghost_layer(MPI_COMM_WORLD, piece);
  CHECK((ghosted.mesh.triangles.size() > piece.mesh.triangles.size()) == (piece.ranks > 1));
  // A value on each own triangle goes to all that have it as a ghost, over the caller's communicator.
  std::vector<std::int64_t> values(ghosted.triangle_numbers.begin(),
                                   ghosted.triangle_numbers.begin() + ghosted.own_triangles);
  values.resize(ghosted.mesh.triangles.size(), -1);
  std::vector<std::vector<std::int64_t>> sent, received;
  std::vector<MPI_Request> requests;
  for (const GhostedPiece::Neighbor& n : ghosted.neighbors) {
    auto& out = sent.emplace_back();
    for (const std::int32_t t : n.sent) out.push_back(values[static_cast<std::size_t>(t)]);
    received.emplace_back(n.received.size());
  }
  for (std::size_t k = 0; k < ghosted.neighbors.size(); ++k) {
    const int rank = to_int(ghosted.neighbors[k].rank);
    MPI_Isend(sent[k].data(), static_cast<int>(sent[k].size()), MPI_INT64_T, rank, 0, MPI_COMM_WORLD,
              &requests.emplace_back());
    MPI_Irecv(received[k].data(), static_cast<int>(received[k].size()), MPI_INT64_T, rank, 0, MPI_COMM_WORLD,
              &requests.emplace_back());
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  for (std::size_t k = 0; k < ghosted.neighbors.size(); ++k)
    for (std::size_t i = 0; i < received[k].size(); ++i)
      values[static_cast<std::size_t>(ghosted.neighbors[k].received[i])] = received[k][i];
  CHECK(values == ghosted.triangle_numbers);
  // Each triangle at a point of the piece is there: around a point that is on no subsegment the angles close.
  std::vector<double> turn(ghosted.mesh.points.size(), 0);
  for (const auto& t : ghosted.mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto at = [&](std::size_t k) { return ghosted.mesh.points[static_cast<std::size_t>(t[(i + k) % 3])]; };
      const Point a = at(0), b = at(1), c = at(2);
      turn[static_cast<std::size_t>(t[i])] += std::atan2((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x),
                                                         (b.x - a.x) * (c.x - a.x) + (b.y - a.y) * (c.y - a.y));
    }
  std::vector<bool> on_boundary(ghosted.mesh.points.size(), false);
  for (const Mesh::Edge& e : ghosted.mesh.edges)
    on_boundary[static_cast<std::size_t>(e.a)] = on_boundary[static_cast<std::size_t>(e.b)] = true;
  std::size_t closed = 0;
  for (std::size_t v = 0; v < static_cast<std::size_t>(ghosted.own_points); ++v)
    if (!on_boundary[v]) {
      CHECK(turn[v] == doctest::Approx(2 * std::numbers::pi));
      ++closed;
    }
  CHECK(closed > 0);
}
