#include "config/words.hpp"

#include <cmath>
#include <filesystem>
#include <map>

#include "base/standard_streams.hpp"
#include "config/value_json.hpp"
#include "job/keys.hpp"

namespace driftmesh::config {
namespace {

using job::KeyInfo;
using job::Value;
using Kind = job::KeyInfo::Kind;

/// The length of a key's section, including the dot; 0 if it has none.
std::size_t section_end(const std::string& name) {
  const std::size_t dot = name.rfind('.');
  return dot == std::string::npos ? 0 : dot + 1;
}

std::string help_of(const KeyInfo& key) {
  return key.unit.empty() ? key.help : key.help + " (" + key.unit + ")";
}

bool is_empty(const Value& value) {
  const std::string text = job::text_of(value);
  return text == "\"\"" || text == "[]" || text == "{}";
}

Json schema_of(const KeyInfo& key);

Json schema_of_record(const std::vector<KeyInfo>& fields) {
  Json properties = Json::object();
  for (const KeyInfo& field : fields) properties[field.name] = schema_of(field);
  return {{"type", "object"}, {"properties", properties}, {"additionalProperties", false}};
}

void add_range(Json& schema, const KeyInfo& key) {
  if (std::isfinite(key.least)) schema[key.above ? "exclusiveMinimum" : "minimum"] = key.least;
  if (std::isfinite(key.most)) schema["maximum"] = key.most;
}

/// A number, or one with a unit, such as 5k, which is text to YAML.
Json number_schema(const KeyInfo& key) {
  Json number = {{"type", key.kind == Kind::kInteger ? "integer" : "number"}};
  add_range(number, key);
  return {{"anyOf", {number, {{"type", "string"}, {"pattern", "^[-+0-9.eE]+[kKmMgGtT]?i?[bB]?$"}}}}};
}

Json choice_schema(const KeyInfo& key) {
  Json choice = {{"enum", key.choices}};
  if (is_empty(key.standard)) choice["enum"].push_back("");
  if (key.or_file.empty()) return choice;
  return {{"anyOf", {choice, {{"type", "string"}, {"pattern", "\\" + key.or_file + "$"}}}}};
}

Json schema_of(const KeyInfo& key) {
  Json schema = {{"description", help_of(key)}};
  switch (key.kind) {
    case Kind::kText:
    case Kind::kFile:
    case Kind::kOutput:
      schema["type"] = "string";
      break;
    case Kind::kChoice:
      schema.update(choice_schema(key));
      break;
    case Kind::kFlag:
      schema["type"] = "boolean";
      break;
    case Kind::kNumber:
    case Kind::kInteger:
      schema.update(number_schema(key));
      break;
    case Kind::kTable:
      schema["type"] = {"object", "array"};
      schema["items"] = {{"type", "string"}, {"pattern", "="}};
      break;
    case Kind::kList:
      schema["type"] = "array";
      schema["items"] = schema_of_record(key.fields);
      break;
    case Kind::kNumbers:
      schema["type"] = "array";
      schema["items"] = number_schema(key);
      break;
    case Kind::kOutputs:
      schema["type"] = "array";
      schema["items"] = {{"type", "string"}};
      break;
  }
  schema["default"] = json_of(key.standard);
  return schema;
}

std::string values_words(const KeyInfo& key) {
  static constexpr const char* kWords[] = {"text",       "file", "file",  "files", "number", "whole number",
                                           "true/false", "",     "table", "list",  "numbers"};
  std::string words = key.of_files ? "table of files" : kWords[static_cast<int>(key.kind)];
  for (const std::string& choice : key.choices) words += (words.empty() ? "" : ", ") + choice;
  if (!key.or_file.empty()) words += ", or a file " + key.or_file;
  if (std::isfinite(key.least)) words += (key.above ? " above " : " from ") + job::shortest_text(key.least);
  if (std::isfinite(key.most)) words += " to " + job::shortest_text(key.most);
  return words;
}

std::string row(const std::string& name, const KeyInfo& key) {
  const std::string standard = is_empty(key.standard) ? "" : job::text_of(key.standard);
  return "| `" + name + "` | " + values_words(key) + " | " + standard + " | " + help_of(key) + " |\n";
}

/// The value in a form that does not depend on the folder of the file it is written to.
Value from_anywhere(const KeyInfo& key, const Value& value) {
  const auto absolute = [&](const std::string& text) {
    return job::with_files(key, text, [](const std::string& file) {
      return is_standard_stream(file) ? file : std::filesystem::absolute(file).string();
    });
  };
  if (const auto* const text = std::get_if<std::string>(&value)) return absolute(*text);
  const auto* const table = std::get_if<std::map<std::string, std::string>>(&value);
  if (table == nullptr) return value;
  std::map<std::string, std::string> moved;
  for (const auto& [name, text] : *table) moved[name] = absolute(text);
  return moved;
}

bool in_experiments(const KeyInfo& key) {
  return (key.entry_points & job::kExperiment) != 0;
}

}  // namespace

std::string json_schema() {
  Json sections = Json::object();
  Json swept = Json::object();
  for (const job::Key& key : job::keys()) {
    if (!in_experiments(key)) continue;
    const std::size_t end = section_end(key.name);
    if (end == 0) {
      sections[key.name] = schema_of(key);
    } else {
      Json& section = sections[key.name.substr(0, end - 1)];
      section["type"] = "object";
      section["additionalProperties"] = false;
      section["properties"][key.name.substr(end)] = schema_of(key);
    }
    swept[key.name] = {{"type", "array"}, {"minItems", 1}, {"items", schema_of(key)}, {"description", help_of(key)}};
  }
  sections["sweep"] = {{"type", "object"},
                       {"description", "Keys, each with a list of values; all combinations are run"},
                       {"properties", swept}};
  const Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                       {"title", "driftmesh experiment"},
                       {"type", "object"},
                       {"properties", sections},
                       {"additionalProperties", false}};
  return schema.dump(2) + "\n";
}

std::string keys_table() {
  std::string table = "| key | value | default | what it is |\n|---|---|---|---|\n";
  for (const job::Key& key : job::keys()) {
    if (!in_experiments(key)) continue;
    table += row(key.name, key);
    for (const KeyInfo& field : key.fields) table += row(key.name + ": " + field.name, field);
  }
  return table;
}

std::string experiment_text(const job::Request& request) {
  std::string text, section;
  for (const job::Key& key : job::keys()) {
    if (!in_experiments(key)) continue;
    const std::size_t end = section_end(key.name);
    const std::string own = key.name.substr(0, end);
    if (own != section && end > 0) text += own.substr(0, end - 1) + ":\n";
    section = own;
    text += (end > 0 ? "  " : "") + key.name.substr(end) + ": " + job::text_of(from_anywhere(key, key.load(request))) +
            "\n";
  }
  return text;
}

std::string experiment_text(const Experiment& experiment) {
  std::string text = experiment_text(experiment.base);
  if (experiment.sweep.empty()) return text;
  text += "sweep:\n";
  for (const Experiment::Axis& axis : experiment.sweep) {
    std::string values;
    for (const Value& value : axis.values)
      values += (values.empty() ? "" : ", ") + job::text_of(from_anywhere(*job::find_key(axis.key).key, value));
    text += "  " + axis.key + ": [" + values + "]\n";
  }
  return text;
}

}  // namespace driftmesh::config
