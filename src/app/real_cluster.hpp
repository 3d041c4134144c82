#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "app/run_record.hpp"
#include "cluster/cluster_run.hpp"
#include "protocol/mpi/mpi_transport.hpp"
#include "runtime/run_plan.hpp"
#include "sizing/make_size_field.hpp"

namespace driftmesh::app {

/// A run for real ranks.
struct RealRun {
  RunPlan plan;                ///< its size field is not used: each rank makes its own
  SizingOptions sizing;        ///< of which
  std::vector<double> shares;  ///< of its time that each rank works; it sleeps through the rest
};

/// The ranks that mpirun has started, or this process alone, and the runs that they make together. All processes of a
/// job make one; then rank 0 says what is run, and the others serve. What a rank throws within a run stops all of them
/// with one message; what rank 0 throws between runs sends the others home.
class RealCluster {
 public:
  RealCluster();
  ~RealCluster();
  RealCluster(const RealCluster&) = delete;
  RealCluster& operator=(const RealCluster&) = delete;

  [[nodiscard]] bool leads() const { return control_.rank() == 0; }
  [[nodiscard]] std::int32_t ranks() const { return control_.ranks(); }

  using Progress = std::function<void(std::int64_t triangles, double forecast)>;
  /// Rank 0: makes a run with all ranks. The record gets what they report; `progress` is rank 0's.
  [[nodiscard]] ClusterRun run(const RealRun& run, RunRecord& record, const Progress& progress);

  /// The other ranks: takes part in runs until rank 0 has no more.
  void serve();

 private:
  [[nodiscard]] std::vector<protocol::Bytes> take_part(const protocol::Bytes& order, const Progress& progress);

  protocol::MpiSession session_;
  protocol::MpiTransport control_;  // for what is said between runs; each run has a transport of its own
};

}  // namespace driftmesh::app
