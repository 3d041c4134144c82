#include "cli/completion.hpp"
#include "cli/completion_words.hpp"

namespace driftmesh::cli {
namespace {

// In the script, `command` is the command so far, `before` the word before the one to be completed.
constexpr const char* kBegin = R"(#compdef @
# Completion of the command lines of @ for zsh. Put it into a folder of $fpath, as _@.
_@() {
  local command=@ before=$words[CURRENT-1] i
  local -a options commands
  for ((i = 2; i < CURRENT; ++i)); do
    case "$command $words[i]" in
)";
constexpr const char* kCommands = R"(        command+=" $words[i]" ;;
    esac
  done
  if [[ $words[CURRENT] == --*=* ]]; then
    before=${words[CURRENT]%%=*}
    compset -P '*='
  fi
  case "$command:$before" in
)";
constexpr const char* kEnd = R"(  esac
}
if [[ $funcstack[1] == _@ ]]; then
  _@ "$@"
else
  compdef _@ @
fi
)";

std::string quoted(const std::string& text) {
  return "'" + replaced(text, '\'', "'\\''") + "'";
}

/// "name:description", the format of _describe.
std::string described(const std::string& name, const std::string& what) {
  return "      " + quoted(name + ":" + replaced(brief(what), ':', "\\:")) + "\n";
}

std::string complete_values(const Option& option) {
  if (!option.choices.empty()) return "compadd -- " + joined(option.choices, " ");
  if (option.completes == Option::Completes::kFile) return "_files";
  if (option.completes == Option::Completes::kFolder) return "_files -/";
  return "_message " + quoted(option.value);
}

std::string word_case(const NamedCommand& named) {
  const Command& command = *named.command;
  std::string text = "    '" + named.name + ":'*)\n      options=(\n";
  for (const Option* option : named_options(command)) text += described("--" + option->name, option->help);
  text +=
      "      )\n      if [[ $words[CURRENT] == -?* ]]; then\n        _describe -o option options\n      else\n        ";
  if (!command.commands.empty()) {
    text += "commands=(\n";
    for (const Command& below : command.commands) text += described(below.name, below.summary);
    text += "      )\n        _describe command commands\n";
  } else if (const Option* argument = argument_of(command); argument != nullptr) {
    text += complete_values(*argument) + "\n";
  } else {
    text += "_describe -o option options\n";
  }
  return text + "      fi ;;\n";
}

}  // namespace

std::string zsh_completion(const Command& program) {
  return written(
      {kBegin, kCommands, kEnd, [](const Option& option) { return " " + complete_values(option); }, word_case},
      program);
}

}  // namespace driftmesh::cli
