#include "cli/help_text.hpp"

#include <algorithm>
#include <sstream>

namespace driftmesh::cli {
namespace {

constexpr std::size_t kColumns = 100;
constexpr std::size_t kNameColumns = 30;

/// The words of `text` in lines that begin at column `indent`, but for the first, which begins at `column`.
std::string wrapped(const std::string& text, std::size_t indent, std::size_t column) {
  std::istringstream words(text);
  std::string result, word;
  bool first_of_line = true;
  while (words >> word) {
    if (!first_of_line && column + 1 + word.size() > kColumns) {
      result += '\n' + std::string(indent, ' ');
      column = indent;
      first_of_line = true;
    }
    if (!first_of_line) result += ' ', ++column;
    result += word;
    column += word.size();
    first_of_line = false;
  }
  return result;
}

/// A name in the left column, and what it means in the right one.
std::string entry(const std::string& name, const std::string& meaning) {
  std::string text = "  " + name;
  if (text.size() + 2 > kNameColumns) text += '\n';
  const std::size_t used = text.back() == '\n' ? 0 : text.size();
  text += std::string(kNameColumns - used, ' ');
  return text + wrapped(meaning, kNameColumns, kNameColumns) + '\n';
}

std::string left_column(const Option& option) {
  if (option.kind == Option::Kind::kPositional) return option.value;
  const std::string letter = option.letter == 0 ? "" : std::string{'-', option.letter, ',', ' '};
  return letter + "--" + option.name + (option.value.empty() ? "" : " " + option.value);
}

std::string options_text(const Command& command) {
  std::string text;
  for (const OptionGroup& group : option_groups(command)) {
    text += "\n" + group.heading + ":\n";
    for (const Option* option : group.options) text += entry(left_column(*option), description(*option));
  }
  return text;
}

std::string commands_text(const Command& command) {
  if (command.commands.empty()) return "";
  std::string text = "\nCommands:\n";
  for (const Command& c : command.commands) text += entry(c.name, c.summary);
  return text;
}

std::string notes_text(const Command& command) {
  std::string text, paragraph;
  std::istringstream lines(command.notes + "\n\n");
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() && !paragraph.empty()) text.append("\n").append(wrapped(paragraph, 0, 0)).append("\n");
    paragraph = line.empty() ? "" : paragraph + line + " ";
  }
  return text;
}

std::string examples_text(const Command& command) {
  if (command.examples.empty()) return "";
  std::string text = command.examples.size() == 1 ? "\nExample:\n" : "\nExamples:\n";
  for (const std::string& example : command.examples) text += "  " + example + "\n";
  return text;
}

}  // namespace

const Option& help_option() {
  static const Option option{.kind = Option::Kind::kFlag, .name = "help", .letter = 'h', .help = "Print this help"};
  return option;
}

std::vector<OptionGroup> option_groups(const Command& command) {
  std::vector<OptionGroup> groups{{"Arguments", {}}, {"Options", {&help_option()}}};
  for (const Option& option : command.options) {
    const std::string heading = option.kind == Option::Kind::kPositional ? "Arguments"
                                : option.group.empty()                   ? "Options"
                                                                         : option.group;
    const auto same = [&](const OptionGroup& group) { return group.heading == heading; };
    auto group = std::find_if(groups.begin(), groups.end(), same);
    if (group == groups.end()) group = groups.insert(groups.end(), {heading, {}});
    group->options.push_back(&option);
  }
  std::erase_if(groups, [](const OptionGroup& group) { return group.options.empty(); });
  return groups;
}

std::string usage_line(const std::string& name, const Command& command) {
  std::string line = name + " [OPTIONS]";
  for (const Option& option : command.options) {
    if (option.kind != Option::Kind::kPositional) continue;
    const std::string value = option.value + (option.repeats ? "..." : "");
    line += option.required ? " " + value : " [" + value + "]";
  }
  return command.commands.empty() ? line : line + " COMMAND";
}

std::string description(const Option& option) {
  std::string text = option.help;
  const bool names_all = std::all_of(option.choices.begin(), option.choices.end(),
                                     [&](const std::string& choice) { return text.find(choice) != std::string::npos; });
  if (!names_all) text += (text.find(':') == std::string::npos ? ": " : "; one of ") + listed(option.choices);
  if (!option.or_file.empty()) text += ", or a file " + option.or_file;
  if (option.repeats && option.kind != Option::Kind::kPositional) text += "; can be given several times";
  if (!option.standard.empty()) text += " [" + option.standard + "]";
  return text;
}

std::string help_text(const std::string& name, const Command& command) {
  std::string text = command.summary + "\nUsage: " + usage_line(name, command) + "\n";
  text += options_text(command) + commands_text(command) + notes_text(command) + examples_text(command);
  if (!command.exit_codes.empty())
    text.append("\n").append(wrapped("Exit code: " + command.exit_codes, 0, 0)).append("\n");
  return text;
}

}  // namespace driftmesh::cli
