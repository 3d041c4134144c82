#include "app/help_text.hpp"

#include <sstream>
#include <utility>

namespace driftmesh::app {

HelpFormatter::HelpFormatter() {
  column_width(kNameColumns);
  label("SUBCOMMAND", "COMMAND");
  label("Positionals", "Arguments");
}

std::string HelpFormatter::make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const {
  std::string text = CLI::Formatter::make_help(app, std::move(name), mode);
  for (std::size_t i; (i = text.find("\n\n\n")) != std::string::npos;) text.erase(i, 1);
  if (const std::size_t i = text.find("Subcommands:"); i != std::string::npos) text.erase(i, 3).replace(i, 1, "C");
  return text;
}

// The name of the value and its default; what is required stands in the usage line.
std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
  std::string text;
  if (!option->get_type_name().empty()) text += " " + option->get_type_name();
  if (!option->get_default_str().empty()) text += "=" + option->get_default_str();
  return text;
}

std::string HelpFormatter::make_option_desc(const CLI::Option* option) const {
  return wrapped(CLI::Formatter::make_option_desc(option), kColumns - kNameColumns);
}

std::string wrapped(const std::string& text, std::size_t columns) {
  std::istringstream words(text);
  std::string result, word;
  std::size_t used = 0;
  while (words >> word) {
    if (used != 0 && used + 1 + word.size() > columns) {
      result += '\n';
      used = 0;
    }
    if (used != 0) result += ' ';
    result += word;
    used += (used != 0 ? 1 : 0) + word.size();
  }
  return result;
}

}  // namespace driftmesh::app
