#pragma once

#include <string>

#include "experiment/experiment_file.hpp"

namespace driftmesh::experiment {

/// The JSON schema of an experiment's file, for editors that check YAML while it is written.
[[nodiscard]] std::string json_schema();

/// All keys as a table in Markdown.
[[nodiscard]] std::string keys_table();

/// An experiment in full: every key with its value, as a file that says the same in any folder, without the sweep.
[[nodiscard]] std::string experiment_text(const Experiment& experiment);

/// The same with the sweep.
[[nodiscard]] std::string experiment_text(const ExperimentFile& file);

/// A value in one line, as YAML reads it back: 0.5, true, "[2, 4]", "{a: b}".
[[nodiscard]] std::string value_text(const Json& value);

/// Every key with its value, by its full name.
[[nodiscard]] Json experiment_json(const Experiment& experiment);

}  // namespace driftmesh::experiment
