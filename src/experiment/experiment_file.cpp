#include "experiment/experiment_file.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>

#include "base/error.hpp"
#include "base/nearest_name.hpp"
#include "base/read_file.hpp"
#include "base/standard_streams.hpp"

namespace driftmesh::experiment {
namespace {

using Kind = KeyInfo::Kind;

/// Where a YAML text comes from: a file, or one setting of the command line.
class Origin {
 public:
  static Origin file(const std::string& path) {
    return {path, std::filesystem::path(path).parent_path().string(), true};
  }
  static Origin setting(const std::string& text) { return {"--set " + text, "", false}; }

  [[nodiscard]] std::string place(const YAML::Mark& mark) const {
    if (!has_lines_ || mark.is_null()) return name_;
    return name_ + ":" + std::to_string(mark.line + 1) + ":" + std::to_string(mark.column + 1);
  }
  [[noreturn]] void fail(const YAML::Mark& mark, const std::string& what, const std::string& next) const {
    throw InputError({place(mark)}, what, next);
  }
  [[nodiscard]] std::string resolved(const std::string& file) const {
    return file.empty() || folder_.empty() ? file : (std::filesystem::path(folder_) / file).string();
  }
  [[nodiscard]] YAML::Node parse(const std::string& text) const {
    try {
      return YAML::Load(text);
    } catch (const YAML::Exception& error) {
      fail(error.mark, error.msg, "this is not YAML");
    }
  }

 private:
  Origin(std::string name, std::string folder, bool has_lines)
      : name_(std::move(name)), folder_(std::move(folder)), has_lines_(has_lines) {}
  std::string name_;
  std::string folder_;
  bool has_lines_;
};

/// A key of text, for what is in a table.
KeyInfo text_key(std::string name) {
  KeyInfo key;
  key.name = std::move(name);
  return key;
}

std::string shortest(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return {text, end};
}

/// Turns what YAML holds into values that a key accepts.
class Values {
 public:
  explicit Values(const Origin& origin) : origin_(origin) {}

  [[nodiscard]] Json value(const KeyInfo& key, const YAML::Node& node) const {
    switch (key.kind) {
      case Kind::kTable:
        return table(key, node);
      case Kind::kList:
        return list(key, node);
      case Kind::kNumbers:
        return numbers(key, node);
      case Kind::kText:
        return text(key, node);
      case Kind::kFile:
        return origin_.resolved(text(key, node));
      case Kind::kChoice:
        return choice(key, node);
      case Kind::kFlag:
        return flag(key, node);
      case Kind::kNumber:
        return number(key, node);
      case Kind::kInteger:
        return static_cast<std::int64_t>(whole(key, node));
    }
    return {};
  }

  [[nodiscard]] Json value(const KeyPath& path, const YAML::Node& node) const {
    return path.entry.empty() ? value(*path.key, node) : Json(text(text_key(path.key->name + "." + path.entry), node));
  }

 private:
  [[noreturn]] void fail(const KeyInfo& key, const YAML::Node& node, const std::string& what,
                         const std::string& next) const {
    origin_.fail(node.Mark(), "'" + key.name + "' " + what, next);
  }

  [[nodiscard]] std::string text(const KeyInfo& key, const YAML::Node& node) const {
    if (!node.IsScalar()) fail(key, node, "is no single value", "give one");
    return node.Scalar();
  }

  [[nodiscard]] Json choice(const KeyInfo& key, const YAML::Node& node) const {
    const std::string given = text(key, node);
    if (std::find(key.choices.begin(), key.choices.end(), given) == key.choices.end())
      fail(key, node, "is '" + given + "'", "the nearest that it can be is '" + nearest_name(given, key.choices) + "'");
    return given;
  }

  [[nodiscard]] Json flag(const KeyInfo& key, const YAML::Node& node) const {
    const std::string given = text(key, node);
    if (given != "true" && given != "false") fail(key, node, "is '" + given + "'", "it is either true or false");
    return given == "true";
  }

  [[nodiscard]] double number(const KeyInfo& key, const YAML::Node& node) const {
    const std::string given = text(key, node);
    double number = 0;
    const auto [end, error] = std::from_chars(given.data(), given.data() + given.size(), number);
    if (error != std::errc{} || end != given.data() + given.size() || !std::isfinite(number))
      fail(key, node, "is '" + given + "'", "give a number");
    if (number < key.least || (key.above && number == key.least))
      fail(key, node, "is " + given, (key.above ? "it must be above " : "it must be at least ") + shortest(key.least));
    if (number > key.most) fail(key, node, "is " + given, "it can be at most " + shortest(key.most));
    return number;
  }

  [[nodiscard]] double whole(const KeyInfo& key, const YAML::Node& node) const {
    const double given = number(key, node);
    constexpr double kExact = 9007199254740992.0;
    if (given != std::floor(given) || std::fabs(given) > kExact)
      fail(key, node, "is " + node.Scalar(), "give a whole number");
    return given;
  }

  [[nodiscard]] Json table(const KeyInfo& key, const YAML::Node& node) const {
    if (!node.IsMap()) fail(key, node, "is no table", "write for example {name: value}");
    Json table = Json::object();
    for (const auto& entry : node) {
      const std::string name = text(key, entry.first);
      if (table.contains(name)) fail(key, entry.first, "has '" + name + "' twice", "remove one of them");
      table[name] = text(text_key(key.name + "." + name), entry.second);
    }
    return table;
  }

  [[nodiscard]] Json numbers(const KeyInfo& key, const YAML::Node& node) const {
    if (!node.IsSequence()) fail(key, node, "is no list", "write for example [1, 0.5]");
    Json list = Json::array();
    for (const YAML::Node& item : node) list.push_back(number(key, item));
    return list;
  }

  [[nodiscard]] Json list(const KeyInfo& key, const YAML::Node& node) const {
    if (!node.IsSequence()) fail(key, node, "is no list", "write for example [{" + key.fields[0].name + ": ...}]");
    Json list = Json::array();
    for (const YAML::Node& item : node) list.push_back(record(key, item));
    return list;
  }

  /// One item of a list.
  [[nodiscard]] Json record(const KeyInfo& key, const YAML::Node& node) const {
    if (!node.IsMap()) fail(key, node, "has an item that is no table", "write for example {ranks: 4, speed: 1e6}");
    Json record;
    for (const KeyInfo& field : key.fields) record[field.name] = field.standard;
    std::set<std::string> seen;
    for (const auto& entry : node) {
      const std::string name = text(key, entry.first);
      const auto field =
          std::find_if(key.fields.begin(), key.fields.end(), [&](const KeyInfo& known) { return known.name == name; });
      if (field == key.fields.end()) {
        std::vector<std::string> known;
        for (const KeyInfo& f : key.fields) known.push_back(f.name);
        fail(key, entry.first, "knows no '" + name + "'", "the nearest one is '" + nearest_name(name, known) + "'");
      }
      if (!seen.insert(name).second) fail(key, entry.first, "has '" + name + "' twice", "remove one of them");
      KeyInfo info = *field;
      info.name = key.name + ": " + name;
      record[name] = value(info, entry.second);
    }
    return record;
  }

  const Origin& origin_;
};

/// Does `work`; where it finds a value wrong, the error says where that was given.
template <class Work>
void place_errors(const ExperimentFile& file, const Work& work) {
  try {
    work();
  } catch (const KeyError& error) {
    auto place = file.places.find(error.key());
    if (place == file.places.end()) place = file.places.find(error.key().substr(0, error.key().find('.')));
    throw InputError({place != file.places.end() ? place->second : file.path},
                     "'" + error.key() + "': " + error.problem(), error.next());
  }
}

/// Reads one file with the settings of the command line.
class Reader {
 public:
  Reader(const std::string& path, const std::vector<std::string>& settings)
      : origin_(Origin::file(path)), settings_(settings) {
    result_.base.name = is_standard_stream(path) ? "experiment" : std::filesystem::path(path).stem().string();
    result_.path = path;
  }

  ExperimentFile read(const std::string& path) {
    const YAML::Node root = origin_.parse(read_file(path));
    if (root.IsMap())
      take_section("", root);
    else if (!root.IsNull())
      origin_.fail(root.Mark(), "not a list of 'key: value' lines", "see docs/experiments.md");
    for (const std::string& setting : settings_) take_setting(setting);
    combine();
    return std::move(result_);
  }

 private:
  [[nodiscard]] static bool is_section(const std::string& name) {
    return std::any_of(keys().begin(), keys().end(), [&](const Key& k) { return k.name.starts_with(name + "."); });
  }

  void take_section(const std::string& prefix, const YAML::Node& node) {
    for (const auto& entry : node) {
      if (!entry.first.IsScalar()) origin_.fail(entry.first.Mark(), "a key that is no word", "see docs/experiments.md");
      const std::string name = prefix + entry.first.Scalar();
      if (name == "sweep")
        take_sweep(entry.second);
      else if (find_key(name).key == nullptr && is_section(name))
        take_subsection(name, entry.first, entry.second);
      else
        take_key(origin_, name, entry.first.Mark(), entry.second);
    }
  }

  void take_subsection(const std::string& name, const YAML::Node& key, const YAML::Node& node) {
    if (node.IsNull()) return;
    if (!node.IsMap())
      origin_.fail(node.Mark(), "'" + name + "' has no single value", "give its keys, indented, below");
    if (!seen_.insert(name).second) origin_.fail(key.Mark(), "'" + name + "' is given twice", "join the two");
    result_.places[name] = origin_.place(key.Mark());
    take_section(name + ".", node);
  }

  [[nodiscard]] KeyPath known_key(const Origin& origin, const std::string& name, const YAML::Mark& mark) const {
    const KeyPath path = find_key(name);
    if (path.key == nullptr)
      origin.fail(mark, "unknown key '" + name + "'", "the nearest one is '" + nearest_key(name) + "'");
    return path;
  }

  void take_key(const Origin& origin, const std::string& name, const YAML::Mark& mark, const YAML::Node& node) {
    const KeyPath path = known_key(origin, name, mark);
    if (&origin == &origin_ && !seen_.insert(name).second)
      origin.fail(mark, "'" + name + "' is given twice", "remove one of them");
    if (node.IsNull()) origin.fail(mark, "'" + name + "' has no value", "give one, or remove the key");
    store(result_.base, path, Values(origin).value(path, node));
    result_.places[path.key->name] = origin.place(node.Mark());
  }

  void take_sweep(const YAML::Node& node) {
    if (!node.IsMap()) origin_.fail(node.Mark(), "'sweep' is no table", "write for example {cluster.ranks: [2, 4, 8]}");
    for (const auto& entry : node) {
      const std::string name = entry.first.IsScalar() ? entry.first.Scalar() : "";
      if (std::any_of(result_.sweep.begin(), result_.sweep.end(), [&](const auto& a) { return a.key == name; }))
        origin_.fail(entry.first.Mark(), "sweep: '" + name + "' is given twice", "join the two");
      take_axis(origin_, name, entry.first.Mark(), entry.second);
    }
  }

  void take_axis(const Origin& origin, const std::string& name, const YAML::Mark& mark, const YAML::Node& values) {
    const KeyPath path = known_key(origin, name, mark);
    if (!values.IsSequence() || values.size() == 0)
      origin.fail(values.Mark(), "sweep: '" + name + "' has no list of values", "write for example [1, 2, 4]");
    ExperimentFile::Axis axis{name, {}};
    for (const YAML::Node& value : values) axis.values.push_back(Values(origin).value(path, value));
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
    const KeyPath path = known_key(origin, name, YAML::Mark::null_mark());
    // YAML takes the colon of `a ? b : c` for that of a table.
    if (value.IsMap() && path.key->kind == Kind::kText) value = YAML::Node(text);
    std::erase_if(result_.sweep, [&](const ExperimentFile::Axis& axis) { return axis.key == name; });
    const bool one_list = path.key->kind == Kind::kList || path.key->kind == Kind::kNumbers;
    if (value.IsSequence() && (!one_list || (value.size() > 0 && value[0].IsSequence())))
      take_axis(origin, name, YAML::Mark::null_mark(), value);
    else
      take_key(origin, name, YAML::Mark::null_mark(), value);
  }

  /// All combinations of the sweep, each checked.
  void combine() {
    result_.points = {{{}, result_.base}};
    for (const ExperimentFile::Axis& axis : result_.sweep) {
      std::vector<SweepPoint> next;
      for (const SweepPoint& point : result_.points)
        for (const Json& value : axis.values) {
          next.push_back(point);
          next.back().values.emplace_back(axis.key, value);
          store(next.back().experiment, find_key(axis.key), value);
        }
      result_.points = std::move(next);
    }
    for (const SweepPoint& point : result_.points) place_errors(result_, [&] { check(point.experiment); });
  }

  Origin origin_;
  const std::vector<std::string>& settings_;
  ExperimentFile result_;
  std::set<std::string> seen_;
};

}  // namespace

ExperimentFile read_experiment(const std::string& path, const std::vector<std::string>& settings) {
  return Reader(path, settings).read(path);
}

void check_processes(const ExperimentFile& file, std::int32_t processes) {
  for (const SweepPoint& point : file.points) place_errors(file, [&] { check_processes(point.experiment, processes); });
}

}  // namespace driftmesh::experiment
