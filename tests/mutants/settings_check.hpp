#pragma once

#include <string>
#include <string_view>

#include "config/experiment.hpp"

// Whether YAML files mean what was read from them. A file of the simplest YAML is read a second time: every key that it
// has must have its value, and every other key its default. For all others, what was read, written, must read back as
// the same. Each function returns what is wrong, or "".

namespace driftmesh::mutants {

/// Checks the settings of driftmesh mesh in `text`, which is in a file of this folder.
[[nodiscard]] std::string check_settings(const config::Settings& settings, std::string_view text,
                                         const std::string& folder);

/// Checks an experiment. Uses a file in the folder.
[[nodiscard]] std::string check_experiment(const config::Experiment& experiment, std::string_view text,
                                           const std::string& folder);

}  // namespace driftmesh::mutants
