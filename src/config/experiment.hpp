#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "job/key.hpp"
#include "job/request.hpp"
#include "job/value.hpp"

/// Requests as YAML files say them: one mesh, or an experiment that sweeps over some keys.
namespace driftmesh::config {

/// Where values of keys, and sections, were given, by their full names: "file:line:column", or "--set key=value".
using SourcePlaces = std::map<std::string, std::string>;

/// The request of one mesh as a file says it.
struct Settings {
  job::Request request;
  SourcePlaces places;
};

/// Reads the settings of `driftmesh mesh`. Keys have their full names, in sections, or the long names of their options:
/// "bounds: {area: 5000}" or "area: 5000". Throws InputError "file:line:column: what; next step" for what YAML cannot
/// parse, unknown keys (with the nearest one), keys given twice, wrong types and values out of range; FileError.
[[nodiscard]] Settings read_settings(const std::string& path);

/// One run of an experiment's sweep.
struct SweepPoint {
  std::vector<std::pair<std::string, job::Value>> values;  ///< of the keys that are swept over
  job::Request request;
};

/// What the file of an experiment says: one request, and what is swept over.
struct Experiment {
  struct Axis {
    std::string key;
    std::vector<job::Value> values;
  };
  job::Request base;
  std::vector<Axis> sweep;         ///< the last axis changes fastest
  std::vector<SweepPoint> points;  ///< all combinations; one if nothing is swept over
  std::string path;
  SourcePlaces places;
};

/// Reads an experiment. `settings` are "key=value" with values as in a file, or "key=[list]" to sweep over; they win
/// over what the file says of that key, a sweep over it included. Throws like read_settings, and for values that do not
/// go together.
[[nodiscard]] Experiment read_experiment(const std::string& path, const std::vector<std::string>& settings);

/// Throws InputError, with the place of what is to be changed, if so many processes, started by mpirun (1 without it),
/// cannot make all runs.
void check_processes(const Experiment& experiment, std::int32_t processes);

/// The error of a key as an InputError: at the place where it, or its section, was given, or else at `otherwise`.
[[nodiscard]] InputError placed(const job::KeyError& error, const SourcePlaces& places, const std::string& otherwise);

}  // namespace driftmesh::config
