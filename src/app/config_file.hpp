#pragma once

#include <string>

namespace CLI {
class App;
}

namespace driftmesh::app {

/// Gives the options of a parsed (sub)command that the command line left out the values that a YAML file has for them.
/// Keys are the long names of options and the names of positional ones: "area: 5000", "output: [a.vtu, b.msh]",
/// "quiet: true". Throws InputError "file:line:column: what; next step" for what YAML cannot parse, for unknown keys
/// (naming the nearest known one), keys given twice, and values that the option refuses; FileError.
void apply_config(CLI::App& command, const std::string& file);

/// The command line that sets all options of a parsed (sub)command as they are now set, wherever they came from, quoted
/// for a shell. Options named in `without` (long names) are left out.
[[nodiscard]] std::string command_line_of(const CLI::App& command, const std::initializer_list<std::string>& without);

}  // namespace driftmesh::app
