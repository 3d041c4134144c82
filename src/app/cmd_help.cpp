#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "base/standard_streams.hpp"
#include "cli/help_text.hpp"
#include "cli/values.hpp"

namespace driftmesh::app {
namespace {

/// The help of the command named by the words, as printed by `driftmesh generate bay --help`.
std::string help_of(const cli::Command& program, const std::vector<std::string>& words) {
  const cli::Command* command = &program;
  std::string name = program.name;
  for (const std::string& word : words) {
    const std::vector<std::string> known = cli::command_names(*command);
    const auto found = std::find(known.begin(), known.end(), word);
    if (found == known.end()) throw cli::UsageError("unknown command '" + word + "'" + cli::did_you_mean(word, known));
    command = &command->commands[static_cast<std::size_t>(found - known.begin())];
    name += " " + word;
  }
  return cli::help_text(name, *command);
}

std::vector<std::string> names_of_all(const cli::Command& program) {
  std::vector<std::string> names{"help"};  // not yet part of the program
  for (const cli::NamedCommand& named : cli::all_commands(program))
    if (named.command != &program) names.push_back(named.command->name);
  return names;
}

}  // namespace

cli::Command help_command(const cli::Command& program) {
  const auto words = std::make_shared<std::vector<std::string>>();
  return {.name = "help",
          .summary = "Print the help of a command",
          .options = {{.kind = cli::Option::Kind::kPositional,
                       .name = "command",
                       .value = "COMMAND",
                       .help = "Name of the command, as in: driftmesh help generate bay",
                       .repeats = true,
                       .choices = names_of_all(program),
                       .take = cli::into(*words)}},
          .run = [words, &program](cli::Call&) {
            print(help_of(program, *words));
            return 0;
          }};
}

}  // namespace driftmesh::app
