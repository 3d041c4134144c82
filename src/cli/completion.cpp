#include "cli/completion.hpp"

#include "cli/completion_words.hpp"
#include "cli/help_text.hpp"

namespace driftmesh::cli {

std::vector<std::string> completion_shells() {
  return {"bash", "zsh", "fish"};
}

std::string completion_script(const Command& program, const std::string& shell) {
  return shell == "bash"  ? bash_completion(program)
         : shell == "zsh" ? zsh_completion(program)
                          : fish_completion(program);
}

namespace {

std::string value_case(const CaseScript& script, const std::string& path, const Option& option) {
  std::vector<std::string> patterns;
  for (const std::string& spelling : spellings(option)) patterns.push_back("'" + path + ":" + spelling + "'");
  return "    " + joined(patterns, " | ") + ")" + script.values(option) + " ;;\n";
}

}  // namespace

std::string written(const CaseScript& script, const Command& program) {
  std::vector<std::string> paths;
  std::string values, words;
  for (const NamedCommand& named : all_commands(program)) {
    if (named.command != &program) paths.push_back("'" + named.name + "'");
    words += script.words(named);
    for (const Option* option : named_options(*named.command))
      if (option->kind == Option::Kind::kValue) values += value_case(script, named.name, *option);
  }
  const std::string known = "      " + joined(paths, " | \\\n        ") + ")\n";
  return replaced(script.begin, '@', program.name) + known + script.commands + values + words +
         replaced(script.end, '@', program.name);
}

std::vector<const Option*> named_options(const Command& command) {
  std::vector<const Option*> options{&help_option()};
  for (const Option& option : command.options)
    if (option.kind != Option::Kind::kPositional) options.push_back(&option);
  return options;
}

const Option* argument_of(const Command& command) {
  for (const Option& option : command.options)
    if (option.kind == Option::Kind::kPositional) return &option;
  return nullptr;
}

std::vector<std::string> spellings(const Option& option) {
  std::vector<std::string> all{"--" + option.name};
  if (option.letter != 0) all.push_back({'-', option.letter});
  return all;
}

std::string brief(const std::string& help) {
  std::size_t end = help.size();
  for (const char* mark : {". ", "; ", " ("}) end = std::min(end, help.find(mark));
  return help.substr(0, end);
}

std::string joined(const std::vector<std::string>& words, const std::string& separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

std::string replaced(const std::string& text, char character, const std::string& by) {
  std::string result;
  for (const char c : text) result += c == character ? by : std::string(1, c);
  return result;
}

}  // namespace driftmesh::cli
