#include "app/config_file.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <set>
#include <vector>

#include "base/error.hpp"
#include "base/nearest_name.hpp"
#include "base/read_file.hpp"

namespace driftmesh::app {
namespace {

/// Reads one file of settings.
class Config {
 public:
  Config(cli::Call& call, const std::string& file) : call_(call), file_(file), given_before_(call) {}

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

  [[nodiscard]] const cli::Option& find(const YAML::Node& key) const {
    const std::string name = key.IsScalar() ? key.Scalar() : "";
    std::vector<std::string> known;
    for (const cli::Option& option : call_.command->options) {
      if (option.name == "config") continue;
      if (option.name == name) return option;
      known.push_back(option.name);
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
    const cli::Option& option = find(key);
    if (!seen_.insert(&option).second)
      fail(key.Mark(), fmt::format("'{}' is given twice", key.Scalar()), "remove one of them");
    std::vector<std::string> values = values_of(value, key);
    if (given_before_.has(option.name)) return;  // the command line wins
    if (option.kind == cli::Option::Kind::kFlag) {
      if (values != std::vector<std::string>{"true"} && values != std::vector<std::string>{"false"})
        fail(value.Mark(), fmt::format("'{}' is {}", key.Scalar(), values.front()), "it is either true or false");
      if (values.front() == "false") return;
      values = {""};
    }
    try {
      for (const std::string& one : values) call_.give(option, one);
    } catch (const cli::UsageError& error) {
      fail(value.Mark(), cli::spelled(option) + ": " + error.what(), "see --help");
    }
  }

  cli::Call& call_;
  const std::string& file_;
  const cli::Call given_before_;
  std::set<const cli::Option*> seen_;
};

}  // namespace

void apply_config(cli::Call& call, const std::string& file) {
  Config(call, file).apply();
}

}  // namespace driftmesh::app
