#include <doctest/doctest.h>

#include <filesystem>
#include <string>

#include "driftmesh/generate.hpp"
#include "driftmesh/repair.hpp"
#include "mesh/digest.hpp"
#include "mpi/mesh_on_ranks.hpp"
#include "pslg/poly_file.hpp"

using namespace driftmesh;
using namespace driftmesh::mpi_test;

namespace {

Pslg of_file(const std::string& name) {
  const std::string path = std::string(DRIFTMESH_SOURCE_DIR) + "/../shared/data/" + name;
  if (!std::filesystem::exists(path)) return {};
  Pslg input = read_poly(path);
  repair(input, path);
  return input;
}

}  // namespace

TEST_CASE("ranks refine the published models, with messages late and out of order") {
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
    if (!outcome.leads) continue;
    if (digest == 0) digest = mesh_digest(outcome.mesh);
    CHECK(mesh_digest(outcome.mesh) == digest);
  }
}
