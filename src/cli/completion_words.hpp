#pragma once

#include <string>
#include <vector>

#include "cli/command.hpp"

namespace driftmesh::cli {

// What the completion of all shells is made of.

/// The options of a command, `--help` among them, without its arguments.
[[nodiscard]] std::vector<const Option*> named_options(const Command& command);

/// The argument that the words of a command are completed as; null if it has none.
[[nodiscard]] const Option* argument_of(const Command& command);

/// "--order", "-o": all spellings of an option.
[[nodiscard]] std::vector<std::string> spellings(const Option& option);

/// What an option is for, in as few words as its help begins with.
[[nodiscard]] std::string brief(const std::string& help);

[[nodiscard]] std::string joined(const std::vector<std::string>& words, const std::string& separator);

/// Replaces each `character` of a text.
[[nodiscard]] std::string replaced(const std::string& text, char character, const std::string& by);

}  // namespace driftmesh::cli
