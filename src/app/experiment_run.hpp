#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "app/real_cluster.hpp"
#include "app/run_record.hpp"
#include "cluster/cluster_run.hpp"
#include "experiment/experiment_file.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh::app {

/// One run of an experiment.
struct ExperimentRun {
  std::string name;  ///< of its files: "run-03"
  std::vector<std::pair<std::string, experiment::Json>> swept;
  std::int32_t repetition = 0;
  experiment::Experiment experiment;

  RunPlan plan;                ///< without a size field
  std::vector<double> speeds;  ///< of the ranks, in triangles a second; of real ones, as they were in this run
  ClusterRun outcome;
  RunRecord record;
};

using RunProgress = std::function<void(std::int64_t triangles, double forecast)>;

/// Makes the run that run.experiment describes, and fills in what came out: on `cluster` if it is one for real ranks,
/// in virtual time otherwise.
void make_run(ExperimentRun& run, RealCluster* cluster, const RunProgress& progress);

/// The slices of work of all ranks and the moves between them, as a Chrome trace, which https://ui.perfetto.dev opens.
[[nodiscard]] std::string chrome_trace(const ExperimentRun& run);

/// Everything about a run, for programs: the record of `driftmesh mesh --json` with the experiment and its outcome.
[[nodiscard]] std::string experiment_record(const ExperimentRun& run);

}  // namespace driftmesh::app
