#pragma once

#include <string>

#include "cli/command.hpp"

namespace driftmesh::app {

/// Gives the options of a command that the call left out the values that a YAML file has for them.
/// Keys are the long names of options and the names of positional ones: "area: 5000", "output: [a.vtu, b.msh]",
/// "quiet: true". Throws InputError "file:line:column: what; next step" for what YAML cannot parse, for unknown keys
/// (naming the nearest known one), keys given twice, and values that the option refuses; FileError.
void apply_config(cli::Call& call, const std::string& file);

}  // namespace driftmesh::app
