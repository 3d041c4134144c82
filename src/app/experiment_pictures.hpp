#pragma once

#include <string>

#include "app/experiment_run.hpp"
#include "app/experiment_table.hpp"

namespace driftmesh::app {

/// Draws a run: FOLDER/NAME-time.png (where the time of each rank went), -load.png (what was left to do over time),
/// -owners-before.png, and, if subdomains moved, -owners-after.png and -moves.png (who moved, when, from where to
/// where).
void draw_run(const ExperimentRun& run, const std::string& folder);

/// Draws FOLDER/sweep.png: time and efficiency over the key that was swept over. Nothing if it was not exactly one key,
/// with numbers as values.
void draw_sweep(const ExperimentTable& table, const std::string& title, const std::string& folder);

}  // namespace driftmesh::app
