#include "config/yaml_values.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/nearest_name.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh::config {
namespace {

using job::KeyError;
using job::KeyInfo;
using job::KeyPath;
using job::Record;
using job::Value;
using Kind = job::KeyInfo::Kind;
using Table = std::map<std::string, std::string>;

class Values {
 public:
  explicit Values(const Origin& origin) : origin_(origin) {}

  [[nodiscard]] Value value(const KeyInfo& key, const YAML::Node& node) const {
    switch (key.kind) {
      case Kind::kTable:
        return table(key, node);
      case Kind::kList:
        return list(key, node);
      case Kind::kNumbers:
        return numbers(key, node);
      case Kind::kOutputs:
        return outputs(key, node);
      case Kind::kOutput:
        return output(key, node);
      case Kind::kFile:
        return origin_.resolved(text(key, node));
      default:
        const Value one = single(key, node);
        const auto* const name = std::get_if<std::string>(&one);
        return name != nullptr ? Value(resolved(key, *name)) : one;
    }
  }

  [[nodiscard]] Value value(const KeyPath& path, const YAML::Node& node) const {
    if (path.entry.empty()) return value(*path.key, node);
    return resolved(*path.key, text(path.key->name + "." + path.entry, node));
  }

 private:
  /// With the files that it names, if it does, as seen from the working directory.
  [[nodiscard]] std::string resolved(const KeyInfo& key, const std::string& value) const {
    return job::with_files(key, value, [this](const std::string& file) { return origin_.resolved(file); });
  }

  [[noreturn]] void fail(const std::string& name, const YAML::Node& node, const std::string& what,
                         const std::string& next) const {
    origin_.fail(node.Mark(), "'" + name + "' " + what, next);
  }

  [[nodiscard]] std::string text(const std::string& name, const YAML::Node& node) const {
    if (!node.IsScalar()) fail(name, node, "is not a single value", "give one");
    return node.Scalar();
  }
  [[nodiscard]] std::string text(const KeyInfo& key, const YAML::Node& node) const { return text(key.name, node); }

  [[nodiscard]] Value single(const KeyInfo& key, const YAML::Node& node) const {
    try {
      return job::read_value(key, text(key, node));
    } catch (const KeyError& error) {
      fail(key.name, node, error.problem().in(full_name), error.next().in(full_name));
    }
  }

  [[nodiscard]] Table table(const KeyInfo& key, const YAML::Node& node) const {
    if (node.IsSequence()) return table_of_words(key, node);
    if (!node.IsMap()) fail(key.name, node, "is not a table", "write for example {name: value}");
    Table table;
    for (const auto& entry : node) {
      const std::string name = text(key, entry.first);
      add(table, key, entry.first, name, text(key.name + "." + name, entry.second));
    }
    return table;
  }

  /// A list of what the command line takes one by one: [name=value, ...].
  [[nodiscard]] Table table_of_words(const KeyInfo& key, const YAML::Node& node) const {
    Table table;
    for (const YAML::Node& item : node) {
      const std::string word = text(key, item);
      const std::size_t equals = word.find('=');
      if (equals == std::string::npos)
        fail(key.name, item, "has '" + word + "' in its list", "write NAME=VALUE, or a table, {name: value}");
      add(table, key, item, word.substr(0, equals), word.substr(equals + 1));
    }
    return table;
  }

  void add(Table& table, const KeyInfo& key, const YAML::Node& node, const std::string& name,
           const std::string& value) const {
    if (!table.emplace(name, resolved(key, value)).second)
      fail(key.name, node, "has '" + name + "' twice", "remove one of them");
  }

  [[nodiscard]] std::vector<double> numbers(const KeyInfo& key, const YAML::Node& node) const {
    if (!node.IsSequence()) fail(key.name, node, "is not a list", "write for example [1, 0.5]");
    std::vector<double> list;
    for (const YAML::Node& item : node) list.push_back(single(key, item).as<double>());
    return list;
  }

  [[nodiscard]] std::vector<std::string> outputs(const KeyInfo& key, const YAML::Node& node) const {
    if (node.IsScalar()) return {named_output(key, node)};
    if (!node.IsSequence()) fail(key.name, node, "is not a list", "write for example [mesh.vtu, mesh.msh]");
    std::vector<std::string> list;
    for (const YAML::Node& item : node) list.push_back(named_output(key, item));
    return list;
  }

  [[nodiscard]] std::string named_output(const KeyInfo& key, const YAML::Node& node) const {
    if (text(key, node).empty()) fail(key.name, node, "is empty", "give it a value, or leave it out");
    return output(key, node);
  }

  /// Inputs may be anywhere, but a file does not choose what is overwritten elsewhere.
  [[nodiscard]] std::string output(const KeyInfo& key, const YAML::Node& node) const {
    const std::string name = text(key, node);
    std::string path = origin_.resolved_output(name);
    if (path.empty() && !name.empty())
      fail(key.name, node, "would be written to '" + name + "', outside of the folder of this file",
           "give a name in that folder, or name it on the command line: --" + key.option);
    return path;
  }

  [[nodiscard]] std::vector<Record> list(const KeyInfo& key, const YAML::Node& node) const {
    if (!node.IsSequence())
      fail(key.name, node, "is not a list", "write for example [{" + key.fields[0].name + ": ...}]");
    std::vector<Record> list;
    for (const YAML::Node& item : node) list.push_back(record(key, item));
    return list;
  }

  /// One item of a list: all fields, with defaults for those that are missing.
  [[nodiscard]] Record record(const KeyInfo& key, const YAML::Node& node) const {
    if (!node.IsMap())
      fail(key.name, node, "has an item that is not a table", "write for example {ranks: 4, speed: 1e6}");
    Record record;
    for (const KeyInfo& field : key.fields) record.emplace_back(field.name, field.standard);
    std::set<std::string> seen;
    for (const auto& entry : node) {
      const std::string name = text(key, entry.first);
      const auto field = std::ranges::find(key.fields, name, &KeyInfo::name);
      if (field == key.fields.end()) refuse_field(key, entry.first, name);
      if (!seen.insert(name).second) fail(key.name, entry.first, "has '" + name + "' twice", "remove one of them");
      KeyInfo info = *field;
      info.name = key.name + ": " + name;
      record[static_cast<std::size_t>(field - key.fields.begin())].second = value(info, entry.second);
    }
    return record;
  }

  [[noreturn]] void refuse_field(const KeyInfo& key, const YAML::Node& node, const std::string& name) const {
    std::vector<std::string> known;
    for (const KeyInfo& field : key.fields) known.push_back(field.name);
    fail(key.name, node, "has no field '" + name + "'", "the nearest one is '" + nearest_name(name, known) + "'");
  }

  const Origin& origin_;
};

}  // namespace

Value value_of(const KeyPath& path, const YAML::Node& node, const Origin& origin) {
  return Values(origin).value(path, node);
}

}  // namespace driftmesh::config
