#include "mutants/settings_check.hpp"

#include <cmath>
#include <fstream>
#include <set>

#include "config/value_json.hpp"
#include "config/words.hpp"
#include "job/keys.hpp"
#include "mutants/fields.hpp"
#include "mutants/yaml_tree.hpp"

namespace driftmesh::mutants {
namespace {

using config::Json;
using Kind = YamlNode::Kind;

/// Numbers may have a unit k, M, G or T, of bytes also B and iB. Parts of a byte count as one.
bool is_number(const std::string& text, const Json& expected) {
  const std::size_t end = std::min(text.find_first_not_of("0123456789.eE+-"), text.size());
  std::string unit = text.substr(end);
  const std::optional<double> value = real_number(std::string_view(text).substr(0, end));
  if (!value) return false;
  for (const char* const rest : {"B", "b", "i"})
    if (unit.ends_with(rest)) unit.pop_back();
  const std::size_t letter = unit.empty() ? 0 : std::string("kKmMgGtT").find(unit);
  if (letter == std::string::npos || unit.size() > 1) return false;
  const double power = unit.empty() ? 0 : static_cast<double>(letter / 2 + 1);
  const auto is_power_of = [&](double base) {
    const double number = *value * std::pow(base, power);
    return expected.get<double>() == (expected.is_number_integer() ? std::ceil(number) : number);
  };
  return is_power_of(1000) || is_power_of(1024);
}

bool matches(const Json& value, const YamlNode& node, const std::string& folder);

bool matches_text(const Json& value, const std::string& text, const std::string& folder) {
  if (value.is_boolean()) return text == (value.get<bool>() ? "true" : "false");
  if (value.is_number()) return is_number(text, value);
  if (value.is_string()) return value == text || value == folder + "/" + text;
  return value.is_array() && value.size() == 1 && value[0].is_string() && matches_text(value[0], text, folder);
}

/// A table as a list of NAME=VALUE.
bool matches_words(const Json& value, const YamlNode& node, const std::string& folder) {
  std::set<std::string> seen;
  for (const YamlNode& item : node.items) {
    const std::size_t equals = item.kind == Kind::kText ? item.text.find('=') : std::string::npos;
    if (equals == std::string::npos) return false;
    const std::string name = item.text.substr(0, equals);
    if (!seen.insert(name).second || !value.contains(name) ||
        !matches_text(value[name], item.text.substr(equals + 1), folder))
      return false;
  }
  return seen.size() == value.size();
}

bool matches(const Json& value, const YamlNode& node, const std::string& folder) {
  if (node.kind == Kind::kList && value.is_object()) return matches_words(value, node, folder);
  if (node.kind == Kind::kText) return matches_text(value, node.text, folder);
  if (node.kind == Kind::kList) {
    if (!value.is_array() || value.size() != node.items.size()) return false;
    for (std::size_t i = 0; i < value.size(); ++i)
      if (!matches(value[i], node.items[i], folder)) return false;
    return true;
  }
  if (!value.is_object()) return false;
  std::set<std::string> seen;
  for (const auto& [key, entry] : node.entries)
    if (!seen.insert(key).second || !value.contains(key) || !matches(value[key], entry, folder)) return false;
  return true;
}

class RequestCheck {
 public:
  RequestCheck(const job::Request& request, job::EntryPoint entry_point, std::string folder)
      : values_(config::json_of(request, entry_point)),
        defaults_(config::json_of(job::Request(), entry_point)),
        folder_(std::move(folder)) {}

  /// Looks at all keys of a table; what is in sections has their names before its own.
  void take(const YamlNode& table, const std::string& section) {
    for (const auto& [name, node] : table.entries) {
      if (section.empty() && name == "sweep") continue;
      job::KeyPath path = job::find_key(section + name);
      const bool is_section = path.key == nullptr && node.kind == Kind::kTable;
      if (path.key == nullptr) path = job::find_option(section + name);  // some are named like sections
      if (is_section)
        take(node, section + name + ".");
      else
        take_key(path, section + name, node);
    }
  }

  /// All keys that the file does not have.
  void take_others() {
    for (const auto& [name, value] : values_.items())
      if (!seen_.contains(name) && name != "name" && value != defaults_[name]) refuse(name);
  }

  [[nodiscard]] const std::string& problem() const { return problem_; }

 private:
  void refuse(const std::string& name) { problem_ = "another value of " + name + ", which is " + values_[name].dump(); }

  void take_key(const job::KeyPath& path, const std::string& name, const YamlNode& node) {
    if (path.key == nullptr) {
      problem_ = "an unknown key " + name;
      return;
    }
    const std::string& full = path.key->name;
    seen_.insert(full);
    Json value = values_[full];
    if (path.negated) value = !value.get<bool>();
    if (!path.entry.empty()) value = value[path.entry];
    const bool is_whole_table = value.is_object() && node.kind == Kind::kTable && path.entry.empty();
    if ((is_whole_table && value.size() != node.entries.size()) || !matches(value, node, folder_)) refuse(full);
  }

  Json values_, defaults_;
  std::string folder_;
  std::set<std::string> seen_;
  std::string problem_;
};

std::string check_request(const job::Request& request, job::EntryPoint entry_point, const YamlNode& tree,
                          const std::string& folder) {
  RequestCheck check(request, entry_point, folder);
  check.take(tree, "");
  check.take_others();
  return check.problem();
}

/// The full name of a key, or of the key of an option.
std::string full_name(const std::string& name) {
  const job::KeyPath path = job::find_option(name);
  return job::find_key(name).key != nullptr || path.key == nullptr ? name : path.key->name;
}

/// That the sweep has the lists of the file, in order, and that all combinations are there.
std::string check_sweep(const config::Experiment& experiment, const YamlNode& tree, const std::string& folder) {
  std::vector<std::pair<std::string, YamlNode>> axes;
  for (const auto& [name, node] : tree.entries)
    if (name == "sweep") axes = node.entries;
  if (axes.size() != experiment.sweep.size()) return "another number of swept keys";
  std::size_t combinations = 1;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const config::Experiment::Axis& axis = experiment.sweep[i];
    Json values = Json::array();
    for (const job::Value& value : axis.values) values.push_back(config::json_of(value));
    if (full_name(axes[i].first) != axis.key || !matches(values, axes[i].second, folder))
      return "another sweep of " + axis.key;
    combinations *= axis.values.size();
  }
  return combinations == experiment.points.size() ? "" : "another number of runs";
}

std::string check_written_again(const config::Experiment& experiment, const std::string& folder) {
  const std::string written = config::experiment_text(experiment);
  const std::string path = folder + "/written-again.yaml";
  std::ofstream(path, std::ios::binary) << written;
  const std::string again = config::experiment_text(config::read_experiment(path, {}));
  return again == written ? "" : "another experiment when written and read again";
}

}  // namespace

std::string check_settings(const config::Settings& settings, std::string_view text, const std::string& folder) {
  const std::optional<YamlNode> tree = yaml_tree(text);
  return tree ? check_request(settings.request, job::kMesh, *tree, folder) : "";
}

std::string check_experiment(const config::Experiment& experiment, std::string_view text, const std::string& folder) {
  if (const std::optional<YamlNode> tree = yaml_tree(text)) {
    if (const std::string problem = check_request(experiment.base, job::kExperiment, *tree, folder); !problem.empty())
      return problem;
    if (const std::string problem = check_sweep(experiment, *tree, folder); !problem.empty()) return problem;
  }
  return check_written_again(experiment, folder);
}

}  // namespace driftmesh::mutants
