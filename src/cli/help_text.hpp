#pragma once

#include <string>
#include <vector>

#include "cli/command.hpp"

namespace driftmesh::cli {

/// What `--help` prints of a command, in lines of at most 100 characters. `name` is its name with those of the commands
/// that it belongs to: "driftmesh generate bay".
[[nodiscard]] std::string help_text(const std::string& name, const Command& command);

/// The options of a command under their headings, `--help` among them: arguments first, then those of no group of their
/// own, then the groups in the order in which they appear.
struct OptionGroup {
  std::string heading;
  std::vector<const Option*> options;
};
[[nodiscard]] std::vector<OptionGroup> option_groups(const Command& command);

/// The option of every command that prints its help.
[[nodiscard]] const Option& help_option();

/// "driftmesh check [OPTIONS] MESH [INPUT]"
[[nodiscard]] std::string usage_line(const std::string& name, const Command& command);

/// What help says of an option: its choices and what holds without it included.
[[nodiscard]] std::string description(const Option& option);

}  // namespace driftmesh::cli
