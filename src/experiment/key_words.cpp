#include "experiment/key_words.hpp"

#include <cmath>
#include <filesystem>

namespace driftmesh::experiment {
namespace {

using Kind = KeyInfo::Kind;

/// Where the section of a key ends: behind its last dot, or 0.
std::size_t section_end(const std::string& name) {
  const std::size_t dot = name.rfind('.');
  return dot == std::string::npos ? 0 : dot + 1;
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

Json schema_of(const KeyInfo& key) {
  Json schema = {{"description", key.help}};
  switch (key.kind) {
    case Kind::kText:
    case Kind::kFile:
      schema["type"] = "string";
      break;
    case Kind::kChoice:
      schema["enum"] = key.choices;
      break;
    case Kind::kFlag:
      schema["type"] = "boolean";
      break;
    case Kind::kNumber:
      schema["type"] = "number";
      break;
    case Kind::kInteger:
      schema["type"] = "integer";
      break;
    case Kind::kTable:
      schema["type"] = "object";
      break;
    case Kind::kList:
      schema["type"] = "array";
      schema["items"] = schema_of_record(key.fields);
      break;
    case Kind::kNumbers:
      schema["type"] = "array";
      schema["items"] = {{"type", "number"}};
      break;
  }
  add_range(key.kind == Kind::kNumbers ? schema["items"] : schema, key);
  if (!key.standard.is_null()) schema["default"] = key.standard;
  return schema;
}

std::string number_words(double value) {
  return value_text(value == std::floor(value) && std::fabs(value) < 1e6 ? Json(static_cast<std::int64_t>(value))
                                                                         : Json(value));
}

std::string values_words(const KeyInfo& key) {
  static constexpr const char* kWords[] = {"text", "file",  "number", "whole number", "true/false",
                                           "",     "table", "list",   "numbers"};
  std::string words = kWords[static_cast<int>(key.kind)];
  for (const std::string& choice : key.choices) words += (words.empty() ? "" : ", ") + choice;
  if (std::isfinite(key.least)) words += (key.above ? " above " : " from ") + number_words(key.least);
  if (std::isfinite(key.most)) words += " to " + number_words(key.most);
  return words;
}

std::string row(const std::string& name, const KeyInfo& key) {
  const bool empty = key.standard.is_null() || key.standard == "" || key.standard.is_structured();
  return "| `" + name + "` | " + values_words(key) + " | " + (empty ? "" : value_text(key.standard)) + " | " +
         key.help + " |\n";
}

std::string quoted(const std::string& text) {
  return Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// The value in words that mean the same wherever the experiment lies that they are written into.
Json from_anywhere(const KeyInfo& key, const Json& value) {
  if (key.kind != Kind::kFile || value == "") return value;
  return std::filesystem::absolute(value.get<std::string>()).string();
}

bool is_plain(const std::string& text) {
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./+-";
  return !text.empty() && text.find_first_not_of(kPlain) == std::string::npos;
}

}  // namespace

std::string value_text(const Json& value) {
  if (value.is_string()) return is_plain(value.get<std::string>()) ? value.get<std::string>() : quoted(value);
  if (!value.is_structured()) return value.dump();
  std::string text;
  for (const auto& item : value.items())
    text += (text.empty() ? "" : ", ") + (value.is_object() ? item.key() + ": " : "") + value_text(item.value());
  return value.is_object() ? "{" + text + "}" : "[" + text + "]";
}

std::string json_schema() {
  Json sections = Json::object();
  Json swept = Json::object();
  for (const Key& key : keys()) {
    const std::size_t end = section_end(key.name);
    if (end == 0) {
      sections[key.name] = schema_of(key);
    } else {
      Json& section = sections[key.name.substr(0, end - 1)];
      section["type"] = "object";
      section["additionalProperties"] = false;
      section["properties"][key.name.substr(end)] = schema_of(key);
    }
    swept[key.name] = {{"type", "array"}, {"minItems", 1}, {"items", schema_of(key)}, {"description", key.help}};
  }
  sections["sweep"] = {{"type", "object"},
                       {"description", "Keys, each with the list of values that it takes; all combinations are run"},
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
  for (const Key& key : keys()) {
    table += row(key.name, key);
    for (const KeyInfo& field : key.fields) table += row(key.name + ": " + field.name, field);
  }
  return table;
}

std::string experiment_text(const Experiment& experiment) {
  std::string text, section;
  for (const Key& key : keys()) {
    const std::size_t end = section_end(key.name);
    const std::string own = key.name.substr(0, end);
    if (own != section && end > 0) text += own.substr(0, end - 1) + ":\n";
    section = own;
    text += (end > 0 ? "  " : "") + key.name.substr(end) + ": " + value_text(from_anywhere(key, key.load(experiment))) +
            "\n";
  }
  return text;
}

std::string experiment_text(const ExperimentFile& file) {
  std::string text = experiment_text(file.base);
  if (file.sweep.empty()) return text;
  text += "sweep:\n";
  for (const ExperimentFile::Axis& axis : file.sweep) {
    Json values = axis.values;
    for (Json& value : values) value = from_anywhere(*find_key(axis.key).key, value);
    text += "  " + axis.key + ": " + value_text(values) + "\n";
  }
  return text;
}

Json experiment_json(const Experiment& experiment) {
  Json all;
  for (const Key& key : keys()) all[key.name] = key.load(experiment);
  return all;
}

}  // namespace driftmesh::experiment
