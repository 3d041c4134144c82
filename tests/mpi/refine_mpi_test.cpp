#include <doctest/doctest.h>

#include <filesystem>
#include <random>
#include <string>

#include "base/byte_stream.hpp"
#include "distributed/assembly.hpp"
#include "distributed/write_distributed.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "mesh/digest.hpp"
#include "mesh/mesher.hpp"
#include "protocol/delaying_transport.hpp"
#include "protocol/mpi_transport.hpp"
#include "pslg/generate.hpp"
#include "pslg/poly_file.hpp"
#include "pslg/repair.hpp"
#include "runtime/plan_run.hpp"
#include "runtime/rank_loop.hpp"
#include "verify/report_text.hpp"
#include "verify/verify.hpp"

using namespace driftmesh;
using namespace driftmesh::protocol;

namespace {

/// What a run is, equal on all ranks.
struct Job {
  Pslg input;
  double cells = 3000;  // area bound = area of the domain over this
  std::int32_t subdomains = 24;
  Presplit presplit = Presplit::kOff;
  std::uint64_t seed = 1;  // of delays and moves
  bool moves = false;      // subdomains are handed over at random
};

/// What rank 0 has of it at the end; on other ranks the counters alone.
struct Outcome {
  MeshPiece mesh;
  QualityBounds bounds;
  std::int64_t moves = 0;
  Rank ranks = 1;
};

Pslg of_file(const std::string& name) {
  const std::string path = std::string(DRIFTMESH_SOURCE_DIR) + "/../shared/data/" + name;
  if (!std::filesystem::exists(path)) return {};
  Pslg input = read_poly(path);
  repair(input, path);
  return input;
}

double area_of(const Triangulation& mesh) {
  return summarize_angles(mesh).total_area;
}

/// Moves random subdomains of this rank to random ranks, now and then.
class Mover {
 public:
  Mover(const Job& job, Rank self, Rank ranks)
      : wanted_(job.moves), ranks_(ranks), random_(job.seed * 131 + static_cast<std::uint64_t>(self)) {}

  void look(RankLoop& loop) {
    if (!wanted_ || loop.subdomains().empty() || random_() % 3 != 0) return;
    auto chosen = loop.subdomains().begin();
    std::advance(chosen, static_cast<std::ptrdiff_t>(random_() % loop.subdomains().size()));
    loop.hand_over(chosen->first, static_cast<Rank>(random_() % static_cast<std::uint64_t>(ranks_)));
  }

 private:
  bool wanted_;
  Rank ranks_;
  std::mt19937_64 random_;
};

Outcome run(const Job& job) {
  MpiTransport transport(MpiSession::world());
  DelayingTransport delaying(transport, job.seed, 30);
  Triangulation mesh = triangulate(job.input);
  prepare_corners(mesh);
  Outcome outcome;
  outcome.bounds = bounds_of(job.input, {.max_area = area_of(mesh) / job.cells});
  DecomposeOptions cutting;
  cutting.subdomains = job.subdomains;
  cutting.bounds = outcome.bounds;
  PlanOptions options;
  options.mapping.ranks = transport.ranks();
  options.presplit = job.presplit;
  options.aggregation = 1 + job.seed % 20;
  options.slice = 25;
  const RunPlan plan = plan_run(decompose_for(mesh, cutting, transport.ranks()), outcome.bounds, options);

  RankLoop loop(delaying, plan);
  Mover mover(job, transport.rank(), transport.ranks());
  run_rank(delaying, [&] {
    mover.look(loop);
    return loop.step();
  });
  ByteWriter own;
  own.value(loop.protocol().counters());
  for (const Bytes& bytes : transport.gather(own.take()))
    outcome.moves += ByteReader(bytes).value<ProtocolCounters>().hand_offs;
  outcome.ranks = transport.ranks();
  transport.close();

  MpiTransport quiet(MpiSession::world());
  ExchangeRunner ranks(quiet);
  std::vector<HeldSubdomain> held;
  for (const auto& [id, subdomain] : loop.subdomains()) held.push_back({id, &subdomain.mesh()});
  PieceAssembly assembly(quiet.rank(), quiet.ranks(), plan.decomposition, held_in_memory(std::move(held)));
  ranks.run(assembly);
  const DistributedPiece piece = assembly.piece(job.input);
  GatherPieces gathering(piece);
  ranks.run(gathering);
  outcome.mesh = std::move(gathering.whole());
  quiet.close();
  return outcome;
}

void check(const Job& job, const Outcome& outcome) {
  if (outcome.mesh.points.empty()) return;  // not rank 0
  const VerifyOptions options{.min_angle = outcome.bounds.min_angle, .max_area = outcome.bounds.max_area};
  const VerifyReport report = verify(outcome.mesh, job.input, options);
  CHECK_MESSAGE(report.accepted(), report_text(report, options));
  CHECK(outcome.mesh.triangles.size() > job.cells);
}

}  // namespace

TEST_CASE("ranks refine the given models, with messages late and out of order") {
  for (const std::string name : {"pipe", "cylinder_flow", "chesapeake", "key", "A"}) {
    CAPTURE(name);
    Job job;
    job.input = of_file(name + ".poly");
    if (job.input.points.empty()) {
      MESSAGE(name << " is not there: skipped");
      continue;
    }
    if (name == "chesapeake") job.cells = 20000;
    check(job, run(job));
  }
}

TEST_CASE("subdomains that move at random while SPLITs fly make a mesh that is right") {
  std::int64_t moves = 0;
  bool leads = false;
  Rank ranks = 1;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    CAPTURE(seed);
    Job job;
    job.input = generate_holes({.columns = 3, .rows = 2});
    repair(job.input);
    job.cells = 20000;
    job.seed = seed;
    job.moves = true;
    const Outcome outcome = run(job);
    check(job, outcome);
    moves += outcome.moves;
    leads = !outcome.mesh.points.empty();
    ranks = outcome.ranks;
  }
  if (leads && ranks > 1) CHECK(moves > 1000);
}

TEST_CASE("with presplit interfaces the mesh is the same however subdomains moved") {
  std::uint64_t digest = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Job job;
    job.input = generate_holes({.columns = 3, .rows = 2});
    repair(job.input);
    job.presplit = Presplit::kOn;
    job.cells = 20000;
    job.seed = seed;
    job.moves = seed > 1;
    const Outcome outcome = run(job);
    check(job, outcome);
    if (outcome.mesh.points.empty()) continue;
    if (digest == 0) digest = mesh_digest(outcome.mesh);
    CHECK(mesh_digest(outcome.mesh) == digest);
  }
}
