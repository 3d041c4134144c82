#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "experiment/experiment.hpp"
#include "experiment/keys.hpp"

namespace driftmesh::experiment {

/// One run of an experiment's sweep.
struct SweepPoint {
  std::vector<std::pair<std::string, Json>> values;  ///< of the keys that are swept over
  Experiment experiment;
};

/// What a file says: one experiment, and what is swept over.
struct ExperimentFile {
  struct Axis {
    std::string key;
    std::vector<Json> values;
  };
  Experiment base;
  std::vector<Axis> sweep;         ///< the last axis changes fastest
  std::vector<SweepPoint> points;  ///< all combinations; one if nothing is swept over
  std::string path;
  /// Where values of keys, and sections, were given: file:line:column.
  std::map<std::string, std::string> places;
};

/// Reads an experiment. `settings` are "key=value" with values as in a file, or "key=[list]" to sweep over; they win
/// over what the file says of that key, a sweep over it included. Throws InputError "file:line:column: what; next step"
/// for what YAML cannot parse, unknown keys (with the nearest one), wrong types, and values that are impossible alone
/// or together; FileError.
[[nodiscard]] ExperimentFile read_experiment(const std::string& path, const std::vector<std::string>& settings);

/// Throws InputError, with the place of what is to be changed, if so many processes, started by mpirun (1 without it),
/// cannot make all runs.
void check_processes(const ExperimentFile& file, std::int32_t processes);

}  // namespace driftmesh::experiment
