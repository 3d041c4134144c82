#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "job/key.hpp"
#include "job/request.hpp"
#include "job/value.hpp"

/// Requests from YAML files: one mesh, or an experiment that sweeps over some keys.
namespace driftmesh::config {

/// The places where keys and sections were given, by their full names: "file:line:column", or "--set key=value".
using SourcePlaces = std::map<std::string, std::string>;

/// The request for one mesh that a file makes.
struct Settings {
  job::Request request;
  SourcePlaces places;
};

/// Reads the settings of `driftmesh mesh`. Keys have their full names, in sections, or the long names of their options:
/// "bounds: {area: 5000}" or "area: 5000". Throws InputError "file:line:column: what; next step" for invalid YAML,
/// unknown keys (with the nearest known one), keys given twice, wrong types and values out of range; FileError if the
/// file cannot be read.
[[nodiscard]] Settings read_settings(const std::string& path);

/// One run of an experiment's sweep.
struct SweepPoint {
  std::vector<std::pair<std::string, job::Value>> values;  ///< swept keys with their values
  job::Request request;
};

/// The content of an experiment's file: one request, and the sweep.
struct Experiment {
  struct Axis {
    std::string key;
    std::vector<job::Value> values;
  };
  job::Request base;
  std::vector<Axis> sweep;         ///< the last axis changes fastest
  std::vector<SweepPoint> points;  ///< all combinations; one if there is no sweep
  std::string path;
  SourcePlaces places;
};

/// Reads an experiment. `settings` are "key=value" with values as in a file, or "key=[list]" for a sweep; they replace
/// the file's value of that key, or its sweep over it. Throws like read_settings, and for values that cannot be
/// combined.
/// A file may name code (see key_with_code) only with `allow_code`, `settings` always.
[[nodiscard]] Experiment read_experiment(const std::string& path, const std::vector<std::string>& settings,
                                         bool allow_code = false);

/// Throws KeyError if the value of a key is code, and a file gave it, by its place, instead of the command line.
void refuse_code_of_file(const job::Request& request, const SourcePlaces& places);

/// Throws InputError, with the place of the setting to change, if not all runs can be made by this number of processes,
/// which mpirun has started (1 without it).
void check_processes(const Experiment& experiment, std::int32_t processes);

/// The error of a key as an InputError, at the place where the key or its section was given, or at `otherwise` if
/// neither was.
[[nodiscard]] InputError placed(const job::KeyError& error, const SourcePlaces& places, const std::string& otherwise);

}  // namespace driftmesh::config
