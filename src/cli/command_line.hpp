#pragma once

#include <string>
#include <vector>

#include "cli/command.hpp"

namespace driftmesh::cli {

/// What run() returns for a command line that cannot be meant.
constexpr int kWrongUsage = 2;

/// Reads the words that follow the name of the program, from left to right, and gives the options of the command their
/// values: "--name VALUE", "--name=VALUE", "-nVALUE"; flags may share a dash; options and arguments mix; behind "--"
/// all are arguments. An option that prints ends it: what follows need not be right. Throws UsageError; `call` then
/// says how far it came.
void parse(const Command& program, const std::vector<std::string>& words, Call& call);

/// Does what the command line of main asks for. Returns the exit code: kWrongUsage, with a message of one line, if it
/// cannot be meant. Other errors of the command pass through.
int run(const Command& program, int argc, const char* const* argv);

}  // namespace driftmesh::cli
