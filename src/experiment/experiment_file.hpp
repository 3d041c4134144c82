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
};

/// Reads an experiment. `settings` are "key=value" with values as in a file, or "key=[list]" to sweep over; they win
/// over what the file says of that key, a sweep over it included. Throws InputError "file:line:column: what; next step"
/// for what YAML cannot parse, unknown keys (with the nearest one), wrong types, and values that are impossible alone
/// or together; FileError.
[[nodiscard]] ExperimentFile read_experiment(const std::string& path, const std::vector<std::string>& settings);

}  // namespace driftmesh::experiment
