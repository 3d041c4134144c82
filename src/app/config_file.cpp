#include "app/config_file.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <set>
#include <vector>

#include "base/error.hpp"
#include "base/nearest_name.hpp"
#include "base/read_file.hpp"

namespace driftmesh::app {
namespace {

std::string key_of(const CLI::Option& option) {
  return option.get_positional() ? option.get_name() : option.get_lnames().empty() ? "" : option.get_lnames().front();
}

bool is_flag(const CLI::Option& option) {
  return option.get_items_expected_max() == 0;
}

/// The options that a file may set, by key.
std::vector<CLI::Option*> settable_options(CLI::App& command) {
  return command.get_options([](const CLI::Option* option) {
    const std::string key = key_of(*option);
    return !key.empty() && key != "help" && key != "config";
  });
}

/// Reads one file of settings.
class Config {
 public:
  Config(CLI::App& command, const std::string& file) : file_(file), options_(settable_options(command)) {}

  void apply() {
    const YAML::Node root = parse();
    if (root.IsNull()) return;
    if (!root.IsMap()) fail(root.Mark(), "not a list of 'option: value' lines", "write for example \"area: 5000\"");
    for (const auto& entry : root) set(entry.first, entry.second);
  }

 private:
  [[noreturn]] void fail(const YAML::Mark& mark, const std::string& what, const std::string& next) const {
    const std::string place = mark.is_null() ? file_ : fmt::format("{}:{}:{}", file_, mark.line + 1, mark.column + 1);
    throw InputError({place}, what, next);
  }

  YAML::Node parse() const {
    try {
      return YAML::Load(read_file(file_));
    } catch (const YAML::Exception& error) {
      fail(error.mark, error.msg, "the file is not YAML");
    }
  }

  CLI::Option* find(const YAML::Node& key) const {
    const std::string name = key.IsScalar() ? key.Scalar() : "";
    std::vector<std::string> known;
    for (CLI::Option* const option : options_) {
      if (key_of(*option) == name) return option;
      known.push_back(key_of(*option));
    }
    fail(key.Mark(), fmt::format("unknown option '{}'", name),
         fmt::format("the nearest one is '{}'", nearest_name(name, known)));
  }

  std::vector<std::string> values_of(const YAML::Node& value, const YAML::Node& key) const {
    if (value.IsScalar()) return {value.Scalar()};
    std::vector<std::string> values;
    if (value.IsSequence())
      for (const YAML::Node& item : value)
        if (item.IsScalar()) values.push_back(item.Scalar());
    if (values.empty() || values.size() != value.size())
      fail(value.IsNull() ? key.Mark() : value.Mark(), fmt::format("'{}' has no value that can be used", key.Scalar()),
           "give one value, or a list of values");
    return values;
  }

  void set(const YAML::Node& key, const YAML::Node& value) {
    CLI::Option* const option = find(key);
    if (!seen_.insert(option).second)
      fail(key.Mark(), fmt::format("'{}' is given twice", key.Scalar()), "remove one of them");
    std::vector<std::string> values = values_of(value, key);
    if (option->count() > 0) return;  // the command line wins
    if (is_flag(*option)) {
      if (values != std::vector<std::string>{"true"} && values != std::vector<std::string>{"false"})
        fail(value.Mark(), fmt::format("'{}' is {}", key.Scalar(), values.front()), "it is either true or false");
      if (values.front() == "false") return;
    }
    try {
      option->add_result(std::move(values));
      option->run_callback();
    } catch (const CLI::ParseError& error) {
      fail(value.Mark(), error.what(), "see --help");
    }
  }

  const std::string& file_;
  std::vector<CLI::Option*> options_;
  std::set<const CLI::Option*> seen_;
};

/// A word as a POSIX shell reads it back.
std::string quoted(const std::string& word) {
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

}  // namespace

void apply_config(CLI::App& command, const std::string& file) {
  Config(command, file).apply();
}

std::string command_line_of(const CLI::App& command, const std::initializer_list<std::string>& without) {
  std::string line;
  for (const CLI::App* app = &command; app != nullptr; app = app->get_parent()) line = app->get_name() + " " + line;
  line.pop_back();
  for (const CLI::Option* option : command.get_options()) {
    const std::string key = key_of(*option);
    if (option->count() == 0 || std::find(without.begin(), without.end(), key) != without.end()) continue;
    if (is_flag(*option)) {
      line += " --" + key;
      continue;
    }
    for (const std::string& value : option->results())
      line += (option->get_positional() ? " " : " --" + key + " ") + quoted(value);
  }
  return line;
}

}  // namespace driftmesh::app
