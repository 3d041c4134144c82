#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "app/run_record.hpp"
#include "cluster/simulate.hpp"
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
  std::vector<double> speeds;  ///< of the ranks, in triangles a second; all 1 on a real cluster
  SimulatedRun outcome;
  RunRecord record;
};

using RunProgress = std::function<void(std::int64_t triangles, double forecast)>;

/// Makes the run that run.experiment describes, in virtual time, and fills in what came out.
void simulate_experiment(ExperimentRun& run, const RunProgress& progress);

/// The slices of work of all ranks and the moves between them, as a Chrome trace, which https://ui.perfetto.dev opens.
[[nodiscard]] std::string chrome_trace(const ExperimentRun& run);

/// Everything about a run, for programs: the record of `driftmesh mesh --json` with the experiment and its outcome.
[[nodiscard]] std::string experiment_record(const ExperimentRun& run);

}  // namespace driftmesh::app
