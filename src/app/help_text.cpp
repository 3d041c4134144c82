#include "app/help_text.hpp"

#include <sstream>
#include <utility>

namespace driftmesh::app {

std::string HelpFormatter::make_option_desc(const CLI::Option* option) const {
  return wrapped(CLI::Formatter::make_option_desc(option), kColumns - kNameColumns);
}

std::string HelpFormatter::make_group(std::string group, bool is_positional,
                                      std::vector<const CLI::Option*> opts) const {
  std::string text = CLI::Formatter::make_group(std::move(group), is_positional, std::move(opts));
  while (text.ends_with("\n\n")) text.pop_back();
  return text;
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
