#pragma once

#include <string>
#include <vector>

#include "cli/command.hpp"

namespace driftmesh::cli {

/// The supported shells.
[[nodiscard]] std::vector<std::string> completion_shells();

/// The script that makes a shell complete the command lines of a program: its commands, their options, the values of
/// options, files and folders. `shell` is one of completion_shells().
[[nodiscard]] std::string completion_script(const Command& program, const std::string& shell);

// The script for each shell.
[[nodiscard]] std::string bash_completion(const Command& program);
[[nodiscard]] std::string zsh_completion(const Command& program);
[[nodiscard]] std::string fish_completion(const Command& program);

}  // namespace driftmesh::cli
