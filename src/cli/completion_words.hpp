#pragma once

#include <string>
#include <vector>

#include "cli/command.hpp"

namespace driftmesh::cli {

// Building blocks of the completion scripts of all shells.

/// The options of a command, `--help` among them, without its arguments.
[[nodiscard]] std::vector<const Option*> named_options(const Command& command);

/// The argument that is completed after a command; null if it has none.
[[nodiscard]] const Option* argument_of(const Command& command);

/// "--order", "-o": all spellings of an option.
[[nodiscard]] std::vector<std::string> spellings(const Option& option);

/// The first few words of an option's help.
[[nodiscard]] std::string brief(const std::string& help);

[[nodiscard]] std::string joined(const std::vector<std::string>& words, const std::string& separator);

/// Replaces each `character` of a text.
[[nodiscard]] std::string replaced(const std::string& text, char character, const std::string& by);

/// A script for shells with `case`, with @ for the name of the program. Between its parts stand the commands (patterns
/// of one case), and what completes a value after "command:--option" and a word after "command:".
struct CaseScript {
  const char* begin;
  const char* commands;
  const char* end;
  std::string (*values)(const Option& option);        ///< what is done for a value, with a space before it
  std::string (*words)(const NamedCommand& command);  ///< the whole case of a word
};
[[nodiscard]] std::string written(const CaseScript& script, const Command& program);

}  // namespace driftmesh::cli
