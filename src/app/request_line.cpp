#include "app/request_line.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "cli/values.hpp"
#include "job/files.hpp"
#include "job/keys.hpp"

namespace driftmesh::app {
namespace {

using job::Key;
using job::KeyError;
using job::Value;
using Kind = job::KeyInfo::Kind;
using Table = std::map<std::string, std::string>;

std::vector<double> numbers_of(const Key& key, const std::string& text) {
  std::vector<double> numbers;
  if (text.empty()) return numbers;
  for (const std::string& word : cli::separated(text)) numbers.push_back(job::read_value(key, word).as<double>());
  return numbers;
}

void require_text(const Key& key, const std::string& text) {
  if (text.empty()) throw KeyError(key.name, "is empty", "give it a value, or leave it out");
}

/// The value of a key after one more word, given its `old` value.
Value given_value(const Key& key, const std::string& text, const Value& old) {
  if (key.kind == Kind::kNumbers) return numbers_of(key, text);
  if (key.kind == Kind::kOutputs) {
    require_text(key, text);
    auto files = old.as<std::vector<std::string>>();
    files.push_back(text);
    return files;
  }
  if (key.kind == Kind::kTable) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) throw KeyError(key.name, "is '" + text + "'", "write NAME=VALUE");
    auto table = old.as<Table>();
    const std::string own = text.substr(equals + 1);
    const auto entry = table.try_emplace(text.substr(0, equals), own).first;
    if (entry->second != own)
      throw KeyError(key.name, "gives " + entry->first + " twice, as '" + entry->second + "' and as '" + own + "'",
                     "remove one of them");
    return table;
  }
  if (key.kind == Kind::kFlag) return !key.option.starts_with("no-");
  require_text(key, text);
  return job::read_value(key, text);
}

/// The arguments of an option, one for each time it is given.
std::vector<std::string> words_of(const Value& value) {
  if (const auto* files = std::get_if<std::vector<std::string>>(&value)) return *files;
  if (const auto* text = std::get_if<std::string>(&value)) return {*text};
  std::vector<std::string> words;
  if (const auto* table = std::get_if<Table>(&value)) {
    for (const auto& [name, entry] : *table) words.push_back(name + "=" + entry);
    return words;
  }
  if (const auto* numbers = std::get_if<std::vector<double>>(&value)) {
    std::string list;
    for (const double number : *numbers) {
      if (!list.empty()) list += ',';
      list += job::shortest_text(number);
    }
    return {list};
  }
  return {job::text_of(value)};
}

cli::Option::Kind kind_of_option(const Key& key) {
  if (key.name == "input.file") return cli::Option::Kind::kPositional;
  return key.kind == Kind::kFlag ? cli::Option::Kind::kFlag : cli::Option::Kind::kValue;
}

cli::Option::Completes completes(const Key& key) {
  const bool file = key.kind == Kind::kFile || key.kind == Kind::kOutput || key.kind == Kind::kOutputs;
  return file ? cli::Option::Completes::kFile : cli::Option::Completes::kNothing;
}

/// Zero and empty defaults are explained in the help of their keys, if at all.
std::string shown_default(const Key& key) {
  const std::string text = job::text_of(key.standard);
  const bool tells = key.kind != Kind::kFlag && text != "0" && text != "\"\"" && text != "[]" && text != "{}" &&
                     key.name != "limits.max-triangles";
  return tells ? text : "";
}

}  // namespace

std::set<std::string> GivenKeys::names() const {
  std::set<std::string> names;
  for (const Item& item : items) names.insert(item.key->name);
  return names;
}

void GivenKeys::apply(job::Request& request) const {
  std::set<const Key*> seen;
  for (const Item& item : items) {
    const Value old = seen.insert(item.key).second ? item.key->standard : item.key->load(request);
    item.key->store(request, given_value(*item.key, item.text, old));
  }
}

void throw_with_option(const KeyError& error, const GivenKeys& given, const config::SourcePlaces& places) {
  const auto by_line =
      std::ranges::any_of(given.items, [&](const GivenKeys::Item& item) { return item.key->name == error.key(); });
  if (!by_line && places.contains(error.key())) throw config::placed(error, places, "");
  throw cli::UsageError(error.text().in(job::words_of(job::kMesh)));
}

std::vector<cli::Option> key_options(job::EntryPoint entry_point, GivenKeys& given, const std::string& group) {
  std::vector<cli::Option> options;
  for (const Key& key : job::keys()) {
    if ((key.entry_points & entry_point) == 0 || key.option.empty()) continue;
    cli::Option option;
    option.kind = kind_of_option(key);
    option.name = key.option;
    option.letter = key.letter;
    option.value = key.name == "input.file" ? "INPUT" : key.value_name;
    option.help = key.option_help.empty() ? key.help : key.option_help;
    option.standard = shown_default(key);
    option.group = key.name == "input.file" ? "" : group.empty() ? key.group : group;
    option.repeats = key.kind == Kind::kOutputs || key.kind == Kind::kTable;
    option.completes = completes(key);
    option.choices = job::choices_at(key, entry_point);
    option.or_file = key.or_file;
    option.take = [&given, &key, entry_point](const std::string& text) {
      try {
        static_cast<void>(given_value(key, text, key.standard));
      } catch (const KeyError& error) {
        // the parser prepends the option
        throw cli::UsageError(KeyText::of("{}; {}", error.problem(), error.next()).in(job::words_of(entry_point)));
      }
      given.items.push_back({&key, text});
    };
    options.push_back(std::move(option));
  }
  return options;
}

std::string command_line_of(const std::string& name, const job::Request& request, job::EntryPoint entry_point) {
  std::string line = name;
  for (const Key& key : job::keys()) {
    const Value value = key.load(request);
    if ((key.entry_points & entry_point) == 0 || key.option.empty() || value == key.standard ||
        key.name == "output.quiet")
      continue;
    if (key.kind == Kind::kFlag)
      line += " --" + key.option;
    else
      for (const std::string& word : words_of(value))
        line += (key.name == "input.file" ? " " : " --" + key.option + " ") + shell_quoted(word);
  }
  return line;
}

std::string shell_quoted(const std::string& word) {
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

}  // namespace driftmesh::app
