#pragma once

#include <string>

#include "config/experiment.hpp"

namespace driftmesh::config {

/// The JSON schema of experiment files, for editors that check YAML while you type.
[[nodiscard]] std::string json_schema();

/// All keys as a table in Markdown.
[[nodiscard]] std::string keys_table();

/// A request in full: every key of an experiment with its value, as a YAML file that means the same in any folder.
[[nodiscard]] std::string experiment_text(const job::Request& request);

/// The same with the sweep.
[[nodiscard]] std::string experiment_text(const Experiment& experiment);

}  // namespace driftmesh::config
