#include "cli/command.hpp"

#include <algorithm>

#include "base/nearest_name.hpp"

namespace driftmesh::cli {
namespace {

void add_commands(const std::string& name, const Command& command, std::vector<NamedCommand>& all) {
  all.push_back({name, &command});
  for (const Command& below : command.commands) add_commands(name + " " + below.name, below, all);
}

}  // namespace

bool Call::has(const std::string& option) const {
  return std::any_of(given.begin(), given.end(), [&](const Given& g) { return g.option->name == option; });
}

void Call::give(const Option& option, const std::string& value) {
  if (!option.repeats && has(option.name)) throw UsageError("is given twice");
  const auto& choices = option.choices;
  const bool is_file = !option.or_file.empty() && value.ends_with(option.or_file);
  if (!choices.empty() && !is_file && std::find(choices.begin(), choices.end(), value) == choices.end())
    throw UsageError("is '" + value + "'; it must be " + listed(choices) + did_you_mean(value, choices));
  if (option.take) option.take(value);
  given.push_back({&option, value});
}

std::vector<std::string> command_names(const Command& command) {
  std::vector<std::string> names;
  for (const Command& below : command.commands) names.push_back(below.name);
  return names;
}

std::vector<NamedCommand> all_commands(const Command& program) {
  std::vector<NamedCommand> all;
  add_commands(program.name, program, all);
  return all;
}

std::string spelled(const Option& option) {
  return option.kind == Option::Kind::kPositional ? option.value : "--" + option.name;
}

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
  return text;
}

std::string did_you_mean(const std::string& name, const std::vector<std::string>& known, const std::string& dashes) {
  const std::string probable = probable_name(name, known);
  return probable.empty() ? "" : " (did you mean " + dashes + probable + "?)";
}

}  // namespace driftmesh::cli
