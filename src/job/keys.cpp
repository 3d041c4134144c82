#include "job/keys.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <utility>

#include "base/nearest_name.hpp"
#include "job/key_table.hpp"

namespace driftmesh::job {
namespace {

using Kind = KeyInfo::Kind;

[[noreturn]] void fail(const KeyInfo& key, const KeyText& what, const KeyText& next) {
  throw KeyError(key.name, what, next);
}

/// Like read_number; a number of seconds may end in s, m (minutes) or h.
bool read_quantity(const KeyInfo& key, std::string text, double& value) {
  double seconds = 1;
  if (key.unit == "seconds" && !text.empty())
    if (const std::size_t unit = std::string_view("smh").find(text.back()); unit != std::string_view::npos) {
      seconds = std::pow(60, unit);
      text.pop_back();
    }
  if (!read_number(text, key.unit == "bytes", value)) return false;
  value *= seconds;
  return true;
}

double number(const KeyInfo& key, const std::string& text) {
  double value = 0;
  if (!read_quantity(key, text, value)) fail(key, "is '" + text + "'", "give a number, as in 20, 1.5e3 or 5k");
  check_range(key, value);
  return value;
}

std::int64_t integer(const KeyInfo& key, const std::string& text) {
  const double value = number(key, text);
  constexpr double kExact = 9007199254740992.0;                         // 2^53
  const double whole = key.unit == "bytes" ? std::ceil(value) : value;  // up: 0 often stands for no limit
  if (whole != std::floor(whole) || std::fabs(whole) > kExact * (key.unit == "bytes" ? 1024 : 1))
    fail(key, "is " + text, "give a whole number");
  return static_cast<std::int64_t>(whole);
}

}  // namespace

const std::vector<Key>& keys() {
  static const std::vector<Key> all = all_keys();
  return all;
}

KeyPath find_key(const std::string& name) {
  for (const Key& k : keys()) {
    if (k.name == name) return {&k, "", false};
    if (k.kind == Kind::kTable && name.starts_with(k.name + ".")) return {&k, name.substr(k.name.size() + 1), false};
  }
  return {};
}

KeyPath find_option(const std::string& option) {
  for (const Key& k : keys())
    if (!option.empty() && k.option == option) return {&k, "", option.starts_with("no-")};
  return {};
}

std::string nearest_key(const std::string& name, EntryPoints entry_point) {
  std::vector<std::string> names;
  for (const Key& k : keys()) {
    if ((k.entry_points & entry_point) == 0) continue;
    names.push_back(k.name);
    if (const std::size_t dot = k.name.find('.'); dot != std::string::npos) names.push_back(k.name.substr(0, dot));
    if (!k.option.empty()) names.push_back(k.option);
  }
  return nearest_name(name, names);
}

void check_range(const KeyInfo& key, double value) {
  if (std::isnan(value)) fail(key, "is not a number", "give one");
  if (value < key.least || (key.above && value == key.least))
    fail(key, "is " + shortest_text(value),
         (key.above ? "it must be above " : "it must be at least ") + shortest_text(key.least));
  if (value > key.most)
    fail(key, "is " + shortest_text(value),
         "it must be at most " + shortest_text(key.most) + (key.why_not_more.empty() ? "" : ": " + key.why_not_more));
}

std::vector<std::string> choices_at(const KeyInfo& key, EntryPoint entry_point) {
  std::vector<std::string> choices = key.choices;
  for (const auto& [choice, only] : key.reserved)
    if (entry_point != only) std::erase(choices, choice);
  return choices;
}

bool names_file(const KeyInfo& key, const std::string& text) {
  if (key.kind == Kind::kFile || key.of_files) return !text.empty();
  return !key.or_file.empty() && text.ends_with(key.or_file);
}

std::vector<std::string> files_in(const std::string& text) {
  if (std::error_code ignored; std::filesystem::exists(text, ignored)) return {text};
  std::vector<std::string> files;
  for (std::size_t begin = 0, end = 0; end != std::string::npos && !text.empty(); begin = end + 1) {
    end = text.find(',', begin);
    files.push_back(text.substr(begin, end - begin));
  }
  return files;
}

std::string words_of_files(const std::string& text) {
  const std::vector<std::string> files = files_in(text);
  if (files.size() < 2) return text;
  return files.front() + " and " + std::to_string(files.size() - 1) + " more";
}

std::string with_files(const KeyInfo& key, const std::string& text,
                       const std::function<std::string(const std::string&)>& moved) {
  if (!names_file(key, text)) return text;
  std::string whole = moved(text);
  if (!key.of_files || files_in(whole).size() == 1) return whole;
  std::string files;
  for (const std::string& file : files_in(text)) {
    files += (file.empty() ? file : moved(file)) + ',';
  }
  files.pop_back();
  return files;
}

const Key* key_with_code(const Request& request) {
  for (const Key& k : keys())
    if (!k.or_file.empty() && k.load(request).as<std::string>().ends_with(k.or_file)) return &k;
  return nullptr;
}

Value read_value(const KeyInfo& key, const std::string& text) {
  switch (key.kind) {
    case Kind::kText:
    case Kind::kFile:
    case Kind::kOutput:
      return text;
    case Kind::kFlag:
      if (text != "true" && text != "false") fail(key, "is '" + text + "'", "it is either true or false");
      return text == "true";
    case Kind::kInteger:
      return integer(key, text);
    case Kind::kNumber:
    case Kind::kNumbers:
      return number(key, text);
    case Kind::kChoice:
      if (names_file(key, text)) return text;
      if (key.standard != Value(text) && std::find(key.choices.begin(), key.choices.end(), text) == key.choices.end())
        fail(key, "is '" + text + "'", "the nearest valid value is '" + nearest_name(text, key.choices) + "'");
      return text;
    case Kind::kOutputs:
    case Kind::kTable:
    case Kind::kList:
      break;
  }
  throw Error(key.name + ": has no single value");
}

void store(Request& request, const KeyPath& path, const Value& value) {
  if (path.entry.empty()) return path.key->store(request, path.negated ? Value(!value.as<bool>()) : value);
  auto table = path.key->load(request).as<std::map<std::string, std::string>>();
  table[path.entry] = value.as<std::string>();
  path.key->store(request, table);
}

}  // namespace driftmesh::job
