#pragma once

#include <string>
#include <vector>

#include "app/experiment_run.hpp"
#include "app/experiment_table.hpp"

namespace driftmesh::app {

/// Plots a run: FOLDER/NAME-time.png (how each rank spent its time), -load.png (work left over time),
/// -owners-before.png and, if subdomains moved, -owners-after.png and -moves.png (which subdomain moved when, from
/// which rank to which).
void draw_run(const ExperimentRun& run, const std::string& folder);

/// The files that draw_run may write for a run of this name, without their folder.
[[nodiscard]] std::vector<std::string> pictures_of_run(const std::string& name);

inline constexpr const char* kSweepPicture = "sweep.png";

/// Plots FOLDER/sweep.png: time and efficiency over the swept key. Does nothing unless exactly one key with numeric
/// values was swept.
void draw_sweep(const ExperimentTable& table, const std::string& title, const std::string& folder);

}  // namespace driftmesh::app
