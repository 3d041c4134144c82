#pragma once

#include <string>
#include <vector>

#include "cli/command.hpp"

namespace driftmesh::cli {

/// The exit code of run() for an invalid command line.
constexpr int kWrongUsage = 2;

/// Parses the words after the name of the program from left to right, and passes their values to the options of the
/// command: "--name VALUE", "--name=VALUE", "-nVALUE"; flags may share a dash; options and arguments may be mixed;
/// after "--", all words are arguments. An option that prints something ends parsing: the rest need not be valid.
/// Throws UsageError; `call` then contains what was parsed until then.
void parse(const Command& program, const std::vector<std::string>& words, Call& call);

/// Parses and runs the command line of main. Returns the exit code: kWrongUsage, after a message of one line, if it is
/// invalid. Other errors of the command pass through.
int run(const Command& program, int argc, const char* const* argv);

}  // namespace driftmesh::cli
