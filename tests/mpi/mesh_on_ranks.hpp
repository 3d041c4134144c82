#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "driftmesh/mesh.hpp"
#include "driftmesh/pslg.hpp"
#include "job/rank_run.hpp"
#include "job/team.hpp"
#include "mesh/bounds.hpp"
#include "protocol/rank_protocol.hpp"
#include "runtime/plan_run.hpp"

namespace driftmesh::mpi_test {

/// The parameters of a run on MPI ranks, equal on all of them.
struct Job {
  Pslg input;
  double cells = 3000;  ///< area bound = area of the domain over this
  std::int32_t subdomains = 24;
  std::int64_t slice = 25;  ///< insertions
  Presplit presplit = Presplit::kOff;
  std::uint64_t seed = 1;    ///< seed for delays and moves
  std::uint64_t delay = 30;  ///< largest number of polls by which a message is delayed
  bool moves = false;        ///< subdomains are handed over at random
  bool drag = false;         ///< one rank rests after each slice, four times as long as the slice took
  bool sleep = false;        ///< finished subdomains sleep
  Balancing balancing;
};

/// The outcome on rank 0; on other ranks, only `leads` is set.
struct Outcome {
  bool leads = false;
  Mesh mesh;
  QualityBounds bounds;
  protocol::ProtocolCounters counters;  ///< sums over all ranks
  std::int64_t forced = 0;              ///< moves made at random
  std::vector<std::string> problems;    ///< wrong owners, counts or termination
};

/// The whole mesh that a team has made, on its rank 0; empty elsewhere. Collective.
[[nodiscard]] Mesh gathered(job::Team& team, const job::RankRun& run);

/// Meshes on all ranks together, over a transport that delivers late and out of order.
[[nodiscard]] Outcome run(const Job& job);

/// CHECKs all oracles on rank 0: the verifier accepts the mesh, each subdomain has one owner, message counts add up,
/// nothing is left over.
void check(const Job& job, const Outcome& outcome);

}  // namespace driftmesh::mpi_test
