#include "config/experiment.hpp"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <set>

#include "balancer/policies/policy_factory.hpp"
#include "base/read_file.hpp"
#include "base/standard_streams.hpp"
#include "config/yaml_origin.hpp"
#include "config/yaml_values.hpp"
#include "driftmesh/error.hpp"
#include "job/check.hpp"
#include "job/keys.hpp"

namespace driftmesh::config {
namespace {

using job::KeyError;
using job::KeyPath;
using job::Request;
using job::Value;
using Kind = job::KeyInfo::Kind;

/// Does `work`; if it rejects a value, the error names the place where the value was given.
template <class Work>
void place_errors(const Experiment& experiment, const Work& work) {
  try {
    work();
  } catch (const KeyError& error) {
    throw placed(error, experiment.places, experiment.path);
  }
}

std::string name_of(const KeyPath& path) {
  return path.entry.empty() ? path.key->name : path.key->name + "." + path.entry;
}

bool is_section(const std::string& name) {
  return std::ranges::any_of(job::keys(), [&](const job::Key& key) { return key.name.starts_with(name + "."); });
}

/// The first command that knows a key with these entry points.
std::string command_with(job::EntryPoints entry_points) {
  if ((entry_points & job::kMesh) != 0) return "driftmesh mesh";
  if ((entry_points & job::kExperiment) != 0) return "driftmesh run";
  return (entry_points & job::kDecompose) != 0 ? "driftmesh decompose" : "driftmesh check";
}

/// Reads the keys of one file, and those set on the command line, into a request.
class KeyReader {
 public:
  using TakeOther = std::function<bool(const std::string& name, const YAML::Node& key, const YAML::Node& value)>;

  /// `other` handles names that are not keys, if it can.
  KeyReader(const Origin& origin, job::EntryPoint entry_point, Request& request, SourcePlaces& places,
            TakeOther other = {})
      : origin_(origin), entry_point_(entry_point), request_(request), places_(places), other_(std::move(other)) {}

  void read_all(const YAML::Node& root) {
    if (root.IsMap())
      take_section("", root);
    else if (!root.IsNull())
      origin_.fail(root.Mark(), "not a list of 'key: value' lines", "see docs/experiments.md");
  }

  void take_key(const Origin& origin, const std::string& name, const YAML::Mark& mark, const YAML::Node& node) {
    const KeyPath path = known_key(origin, name, mark);
    const std::string full = name_of(path);
    if (&origin == &origin_ && !seen_.insert(full).second)
      origin.fail(mark, "'" + name + "' is given twice", "remove one of them");
    if (node.IsNull()) origin.fail(mark, "'" + name + "' has no value", "give one, or remove the key");
    job::store(request_, path, value_of(path, node, origin));
    places_[path.key->name] = origin.place(node.Mark());
  }

  /// The key with this name, or with an option of this name.
  [[nodiscard]] KeyPath known_key(const Origin& origin, const std::string& name, const YAML::Mark& mark) const {
    KeyPath path = job::find_key(name);
    if (path.key == nullptr) path = job::find_option(name);
    if (path.key == nullptr)
      origin.fail(mark, "unknown key '" + name + "'",
                  "the nearest one is '" + job::nearest_key(name, entry_point_) + "'");
    if ((path.key->entry_points & entry_point_) == 0)
      origin.fail(mark,
                  "'" + name + "' is a key of " + command_with(path.key->entry_points) + ", not of " +
                      command_with(entry_point_),
                  "remove it");
    return path;
  }

 private:
  void take_section(const std::string& prefix, const YAML::Node& node) {
    for (const auto& entry : node) {
      if (!entry.first.IsScalar())
        origin_.fail(entry.first.Mark(), "a key that is not a word", "see docs/experiments.md");
      const std::string name = prefix + entry.first.Scalar();
      const bool is_one_value = entry.second.IsScalar() || entry.second.IsSequence();
      if (!names_.insert(name).second)
        origin_.fail(entry.first.Mark(), "'" + name + "' is given twice",
                     is_one_value ? "remove one of them" : "join the two");
      if (other_ && other_(name, entry.first, entry.second)) continue;
      if (is_section(name) && !is_option(name, entry.second))
        take_subsection(name, entry.first, entry.second);
      else
        take_key(origin_, name, entry.first.Mark(), entry.second);
    }
  }

  /// Some options are named like sections, which have no single value.
  [[nodiscard]] static bool is_option(const std::string& name, const YAML::Node& node) {
    return !node.IsMap() && !node.IsNull() && job::find_option(name).key != nullptr;
  }

  void take_subsection(const std::string& name, const YAML::Node& key, const YAML::Node& node) {
    if (node.IsNull()) return;
    if (!node.IsMap())
      origin_.fail(node.Mark(), "'" + name + "' has no single value", "give its keys, indented, below");
    places_[name] = origin_.place(key.Mark());
    take_section(name + ".", node);
  }

  const Origin& origin_;
  job::EntryPoint entry_point_;
  Request& request_;
  SourcePlaces& places_;
  TakeOther other_;
  std::set<std::string> names_;  // as they are in the file
  std::set<std::string> seen_;   // keys in full
};

/// Reads the file of an experiment and the settings of the command line.
class ExperimentReader {
 public:
  ExperimentReader(const std::string& path, bool allow_code)
      : allow_code_(allow_code),
        origin_(Origin::file(path)),
        keys_(origin_, job::kExperiment, result_.base, result_.places,
              [this](const std::string& name, const YAML::Node&, const YAML::Node& value) {
                if (name != "sweep") return false;
                take_sweep(value);
                return true;
              }) {
    if (!is_standard_stream(path)) result_.base.name = std::filesystem::path(path).stem().string();
    result_.path = path;
  }

  Experiment read(const std::vector<std::string>& settings) {
    keys_.read_all(origin_.parse(read_file(result_.path)));
    for (const std::string& setting : settings) take_setting(setting);
    combine();
    return std::move(result_);
  }

 private:
  void take_sweep(const YAML::Node& node) {
    if (!node.IsMap())
      origin_.fail(node.Mark(), "'sweep' is not a table", "write for example {cluster.ranks: [2, 4, 8]}");
    for (const auto& entry : node) {
      const std::string name = entry.first.IsScalar() ? entry.first.Scalar() : "";
      take_axis(origin_, name, entry.first.Mark(), entry.second);
    }
  }

  void take_axis(const Origin& origin, const std::string& name, const YAML::Mark& mark, const YAML::Node& values) {
    const KeyPath path = keys_.known_key(origin, name, mark);
    if (!values.IsSequence() || values.size() == 0)
      origin.fail(values.Mark(), "sweep: '" + name + "' has no list of values", "write for example [1, 2, 4]");
    if (path.negated) origin.fail(mark, "sweep: '" + name + "' is not a key", "sweep over '" + path.key->name + "'");
    Experiment::Axis axis{name_of(path), {}};
    if (std::ranges::any_of(result_.sweep, [&](const auto& other) { return other.key == axis.key; }))
      origin.fail(mark, "sweep: '" + name + "' is given twice", "join the two");
    for (const YAML::Node& value : values) axis.values.push_back(value_of(path, value, origin));
    result_.sweep.push_back(std::move(axis));
    result_.places[path.key->name] = origin.place(values.Mark());
  }

  void take_setting(const std::string& setting) {
    const Origin origin = Origin::setting(setting);
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos) origin.fail({}, "no value", "write --set key=value");
    const std::string name = setting.substr(0, equals);
    const std::string text = setting.substr(equals + 1);
    YAML::Node value = origin.parse(text);
    const KeyPath path = keys_.known_key(origin, name, YAML::Mark::null_mark());
    // YAML takes `a ? b : c` for a table because of its colon.
    if (value.IsMap() && path.key->kind == Kind::kText) value = YAML::Node(text);
    std::erase_if(result_.sweep, [&](const Experiment::Axis& axis) { return axis.key == name_of(path); });
    const bool one_list = path.key->kind == Kind::kList || path.key->kind == Kind::kNumbers;
    if (value.IsSequence() && (!one_list || (value.size() > 0 && value[0].IsSequence())))
      take_axis(origin, name, YAML::Mark::null_mark(), value);
    else
      keys_.take_key(origin, name, YAML::Mark::null_mark(), value);
  }

  /// All combinations of the sweep, each checked.
  void combine() {
    result_.points = {{{}, result_.base}};
    for (const Experiment::Axis& axis : result_.sweep) {
      std::vector<SweepPoint> next;
      for (const SweepPoint& point : result_.points)
        for (const Value& value : axis.values) {
          next.push_back(point);
          next.back().values.emplace_back(axis.key, value);
          job::store(next.back().request, job::find_key(axis.key), value);
        }
      result_.points = std::move(next);
    }
    place_errors(result_, [&] {
      for (const SweepPoint& point : result_.points) check_point(point.request);
    });
  }

  void check_point(const Request& request) const {
    const Request::Input& input = request.input;
    if (input.file.empty() && input.generator.empty() && input.contour.empty())
      throw KeyError("input.file", "is missing",
                     "name a file with {input.file}, or what to generate with {input.generate}");
    if (!allow_code_) refuse_code_of_file(request, result_.places);
    job::check(request, job::place_of(request, job::kExperiment, false), balancer::make_policy);
  }

  bool allow_code_;
  Experiment result_;
  Origin origin_;
  KeyReader keys_;
};

}  // namespace

Settings read_settings(const std::string& path) {
  Settings settings;
  const Origin origin = Origin::file(path);
  KeyReader(origin, job::kMesh, settings.request, settings.places).read_all(origin.parse(read_file(path)));
  return settings;
}

Experiment read_experiment(const std::string& path, const std::vector<std::string>& settings, bool allow_code) {
  return ExperimentReader(path, allow_code).read(settings);
}

void refuse_code_of_file(const Request& request, const SourcePlaces& places) {
  const job::Key* const key = job::key_with_code(request);
  const auto place = key == nullptr ? places.end() : places.find(key->name);
  if (place == places.end() || Origin::is_setting(place->second)) return;
  throw KeyError(key->name, "is code, " + key->load(request).as<std::string>() + ", which would run",
                 "if you trust it, give --allow-code, or name it on the command line");
}

void check_processes(const Experiment& experiment, std::int32_t processes) {
  place_errors(experiment, [&] {
    for (const SweepPoint& point : experiment.points) {
      const job::PlaceKind place = job::place_of(point.request, job::kExperiment, false);
      if (place != job::kSimulated)
        job::check_ranks(point.request, place, processes);
      else if (processes > 1)
        throw KeyError("cluster.kind",
                       "is simulated, which takes one process, but mpirun has started " + std::to_string(processes),
                       "start it without mpirun, or write kind: real");
    }
  });
}

InputError placed(const KeyError& error, const SourcePlaces& places, const std::string& otherwise) {
  auto place = places.find(error.key());
  if (place == places.end()) place = places.find(error.key().substr(0, error.key().find('.')));
  return {{place != places.end() ? place->second : otherwise},
          "'" + error.key() + "' " + error.problem().in(full_name),
          error.next().in(full_name)};
}

}  // namespace driftmesh::config
