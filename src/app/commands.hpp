#pragma once

#include "cli/command.hpp"

namespace driftmesh::app {

// The commands of the program. They throw driftmesh::Error for errors that the user can fix: main prints the message
// and exits with 1, or with 3 for a LimitError.

[[nodiscard]] cli::Command mesh_command();
[[nodiscard]] cli::Command adapt_command();
[[nodiscard]] cli::Command calibrate_command();
[[nodiscard]] cli::Command check_command();
[[nodiscard]] cli::Command clean_command();
[[nodiscard]] cli::Command convert_command();
[[nodiscard]] cli::Command decompose_command();
[[nodiscard]] cli::Command generate_command();
[[nodiscard]] cli::Command plot_command();
[[nodiscard]] cli::Command replay_command();
[[nodiscard]] cli::Command report_command();
[[nodiscard]] cli::Command run_command();
[[nodiscard]] cli::Command triangle_command();
/// These refer to the whole program, which must outlive them.
[[nodiscard]] cli::Command config_command(const cli::Command& program);
[[nodiscard]] cli::Command help_command(const cli::Command& program);

}  // namespace driftmesh::app
