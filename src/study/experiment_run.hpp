#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cluster/cluster_run.hpp"
#include "config/experiment.hpp"
#include "job/record.hpp"
#include "job/watch.hpp"
#include "runtime/run_plan.hpp"
#include "study/real_cluster.hpp"

namespace driftmesh::study {

/// One run of an experiment.
struct ExperimentRun {
  std::string name;  ///< stem of its files: "run-03"
  std::vector<std::pair<std::string, job::Value>> swept;
  std::int32_t repetition = 0;
  job::Request request;

  RunPlan plan;                   ///< without a size field
  IdVector<Rank, double> speeds;  ///< triangles per second of each rank; for real ranks, measured in this run
  ClusterRun outcome;
  IdVector<SubdomainId, double> work;  ///< triangles on each subdomain (see work_done)
  double ideal = 0;                    ///< seconds, if every rank computed from start to end
  double oracle = 0;                   ///< seconds, with the best mapping of whole subdomains (see oracle_seconds)
  job::RunRecord record;
};

/// Makes the run described by run.request, and fills in the results: on `cluster` if it asks for real ranks, otherwise
/// in virtual time.
void make_run(ExperimentRun& run, RealCluster* cluster, job::Watch& watch);

/// Everything about a run, for programs: the record of `driftmesh mesh --json` with the experiment and its outcome.
[[nodiscard]] std::string experiment_record(const ExperimentRun& run);

}  // namespace driftmesh::study
