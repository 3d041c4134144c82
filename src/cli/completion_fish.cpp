#include "cli/completion.hpp"
#include "cli/completion_words.hpp"

namespace driftmesh::cli {
namespace {

constexpr const char* kBegin =
    R"(# Completion of the command lines of @ for fish. Put it into share/fish/vendor_completions.d, as @.fish.
function __@_in # whether the command line begins with these words
    string match -q -- "$argv *" (string join -- ' ' (commandline -opc))' '
end
function __@_is # whether nothing else stands on it
    test "$argv" = (string join -- ' ' (commandline -opc))
end
complete -c @ -f
)";

std::string quoted(const std::string& text) {
  return "'" + replaced(replaced(text, '\\', "\\\\"), '\'', "\\'") + "'";
}

std::string values_of(const Option& option) {
  if (!option.choices.empty()) return " -x -a " + quoted(joined(option.choices, " "));
  if (option.completes == Option::Completes::kFile) return " -r -F";
  if (option.completes == Option::Completes::kFolder) return " -x -a '(__fish_complete_directories)'";
  return " -x";
}

std::string line(const Command& program, const std::string& condition, const std::string& rest) {
  return "complete -c " + program.name + " -n '__" + program.name + "_" + condition + "'" + rest + "\n";
}

std::string lines_of(const Command& program, const NamedCommand& named) {
  const Command& command = *named.command;
  const std::string condition = (command.commands.empty() ? "in " : "is ") + named.name;
  std::string text;
  for (const Command& below : command.commands)
    text += line(program, condition, " -a " + below.name + " -d " + quoted(brief(below.summary)));
  for (const Option* option : named_options(command)) {
    const std::string letter = option->letter == 0 ? "" : std::string(" -s ") + option->letter;
    const std::string values = option->kind == Option::Kind::kFlag ? "" : values_of(*option);
    text += line(program, condition, " -l " + option->name + letter + values + " -d " + quoted(brief(option->help)));
  }
  if (const Option* argument = argument_of(command); argument != nullptr)
    text +=
        line(program, condition, argument->choices.empty() ? " -F" : " -a " + quoted(joined(argument->choices, " ")));
  return text;
}

}  // namespace

std::string fish_completion(const Command& program) {
  std::string text = replaced(kBegin, '@', program.name);
  for (const NamedCommand& named : all_commands(program)) text += lines_of(program, named);
  return text;
}

}  // namespace driftmesh::cli
