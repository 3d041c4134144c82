#pragma once

#include <cstdint>

#include "job/mpi/mpi_team.hpp"
#include "job/on_ranks.hpp"
#include "protocol/mpi/mpi_transport.hpp"
#include "study/pdr/lattice_place.hpp"

namespace driftmesh::study {

/// The ranks that mpirun has started, or this process alone, and their joint runs. All processes of a job construct
/// one; then rank 0 decides what to run, and the others serve. An error ends a run on all ranks, and rank 0 gets it; an
/// exception on rank 0 between runs ends the other ranks.
class RealCluster {
 public:
  RealCluster();
  ~RealCluster();
  RealCluster(const RealCluster&) = delete;
  RealCluster& operator=(const RealCluster&) = delete;

  [[nodiscard]] bool leads() const { return team_.leads(); }
  [[nodiscard]] std::int32_t ranks() const { return team_.ranks(); }

  /// Rank 0: calls all ranks to a run by this method, and returns their place. It must make a mesh there next, and ask
  /// for its report.
  [[nodiscard]] job::Place& call(job::Method method);

  /// The other ranks: takes part in runs until rank 0 has no more.
  void serve();

 private:
  [[nodiscard]] job::Place& place_for(job::Method method);

  protocol::MpiSession session_;
  job::MpiTeam team_;
  job::OnRanks subdomains_;
  pdr::LatticeOnRanks lattice_;
};

}  // namespace driftmesh::study
