#include "cli/manual_page.hpp"

#include <sstream>

#include "base/letter_case.hpp"
#include "cli/help_text.hpp"

namespace driftmesh::cli {
namespace {

/// Text as roff prints it: a dash that can be copied, no quotes that end an argument, and no request at the beginning.
std::string escaped(const std::string& text) {
  std::string result = text.starts_with('.') || text.starts_with('\'') ? "\\&" : "";
  for (const char c : text) {
    if (c == '-')
      result += "\\-";
    else if (c == '\\')
      result += "\\e";
    else if (c == '"')
      result += "\\(dq";
    else
      result += c;
  }
  return result;
}

std::string bold(const std::string& text) {
  return "\\fB" + escaped(text) + "\\fR";
}

std::string italic(const std::string& text) {
  return "\\fI" + escaped(text) + "\\fR";
}

/// The paragraphs of a text whose lines may be broken anywhere.
std::string paragraphs(const std::string& text) {
  std::string result;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) result += line.empty() ? ".PP\n" : escaped(line) + "\n";
  return result;
}

std::string tag(const Option& option) {
  if (option.kind == Option::Kind::kPositional) return italic(option.value);
  const std::string letter = option.letter == 0 ? "" : bold(std::string{'-', option.letter}) + ", ";
  return letter + bold("--" + option.name) + (option.value.empty() ? "" : " " + italic(option.value));
}

std::string options_text(const Command& command) {
  std::string text;
  for (const OptionGroup& group : option_groups(command)) {
    text += ".PP\n" + escaped(group.heading) + ":\n";
    for (const Option* option : group.options)
      text += ".TP\n" + tag(*option) + "\n" + escaped(description(*option)) + ".\n";
  }
  return text;
}

std::string examples_text(const Command& command) {
  if (command.examples.empty()) return "";
  std::string text = command.examples.size() == 1 ? ".PP\nExample:\n.PP\n.EX\n" : ".PP\nExamples:\n.PP\n.EX\n";
  for (const std::string& example : command.examples) text += escaped(example) + "\n";
  return text + ".EE\n";
}

std::string command_text(const NamedCommand& named) {
  const Command& command = *named.command;
  std::string text = ".SS " + escaped(usage_line(named.name, command)) + "\n" + escaped(command.summary) + ".\n";
  text += options_text(command);
  if (!command.notes.empty()) text += ".PP\n" + paragraphs(command.notes);
  text += examples_text(command);
  if (!command.exit_codes.empty()) text += ".PP\nExit code: " + escaped(command.exit_codes) + ".\n";
  return text;
}

}  // namespace

std::string manual_page(const Command& program, const std::string& version) {
  std::string text = ".TH " + upper_case(program.name) + " 1 \"\" \"" + version + "\" \"User Commands\"\n";
  text += ".SH NAME\n" + program.name + " \\- " + escaped(program.summary) + "\n";
  text += ".SH SYNOPSIS\n";
  for (const Command& command : program.commands)
    text += ".B " + escaped(program.name + " " + command.name) + "\n[\\fIOPTIONS\\fR] ...\n.br\n";
  text += ".SH DESCRIPTION\n" + paragraphs(program.notes) + ".SH OPTIONS\n" + options_text(program);
  text += ".SH COMMANDS\n";
  const std::vector<NamedCommand> all = all_commands(program);
  for (auto named = std::next(all.begin()); named != all.end(); ++named) text += command_text(*named);
  return text;
}

}  // namespace driftmesh::cli
