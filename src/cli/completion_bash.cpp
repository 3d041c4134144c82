#include "cli/completion.hpp"
#include "cli/completion_words.hpp"

namespace driftmesh::cli {
namespace {

// In the script, `path` is the command so far, `before` the word before the one to be completed.
constexpr const char* kBegin = R"(# Completion of the command lines of @ for bash. Source it, or put it into
# share/bash-completion/completions/@.
_@() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} path=@
  local options='' words='' files='' i
  if [[ $word == '=' ]]; then # of --name=
    word=''
  elif [[ $before == '=' ]]; then # of --name=value
    before=${COMP_WORDS[COMP_CWORD - 2]}
  fi
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case "$path ${COMP_WORDS[i]}" in
)";
constexpr const char* kCommands = R"(        path+=" ${COMP_WORDS[i]}" ;;
    esac
  done
  case "$path:$before" in
)";
constexpr const char* kEnd = R"(  esac
  if [[ $word == -?* && -n $options ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word")
  elif [[ -n $files ]]; then
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen "$files" -- "$word")
  else
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
  fi
}
complete -F _@ @
)";

/// The possible values of an option or argument.
std::string values_of(const Option& option) {
  if (!option.choices.empty()) return " words='" + joined(option.choices, " ") + "'";
  if (option.completes == Option::Completes::kFile) return " files=-f";
  if (option.completes == Option::Completes::kFolder) return " files=-d";
  return "";
}

std::string word_case(const NamedCommand& named) {
  const Command& command = *named.command;
  std::vector<std::string> options;
  for (const Option* option : named_options(command)) options.push_back("--" + option->name);
  std::string text = "    '" + named.name + ":'*) options='" + joined(options, " ") + "'";
  if (!command.commands.empty()) text += " words='" + joined(command_names(command), " ") + "'";
  if (const Option* argument = argument_of(command); argument != nullptr) text += values_of(*argument);
  return text + " ;;\n";
}

}  // namespace

std::string bash_completion(const Command& program) {
  return written({kBegin, kCommands, kEnd, values_of, word_case}, program);
}

}  // namespace driftmesh::cli
