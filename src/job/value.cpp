#include "job/value.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "base/formatted.hpp"
#include "base/from_chars.hpp"

namespace driftmesh::job {
namespace {

/// The power of a thousand that a unit stands for; -1: unknown unit.
int power_of(std::string_view unit, bool binary) {
  if (binary && (unit.ends_with('B') || unit.ends_with('b'))) unit.remove_suffix(1);
  if (binary && unit.size() == 2 && unit[1] == 'i') unit.remove_suffix(1);
  if (unit.empty()) return 0;
  const std::size_t letter = std::string_view("kKmMgGtT").find(unit.front());
  return unit.size() == 1 && letter != std::string_view::npos ? static_cast<int>(letter) / 2 + 1 : -1;
}

bool is_plain(const std::string& text) {
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./+-";
  return !text.empty() && text.find_first_not_of(kPlain) == std::string::npos;
}

template <class Items, class TextOf>
std::string listed(const Items& items, const TextOf& item_text) {
  std::vector<std::string> texts;
  for (const auto& item : items) texts.push_back(item_text(item));
  return joined(texts, ", ");
}

std::string record_text(const Record& record) {
  return formatted("{{{}}}", listed(record, [](const auto& field) {
                     return formatted("{}: {}", field.first, text_of(field.second));
                   }));
}

struct TextOf {
  std::string operator()(bool value) const { return value ? "true" : "false"; }
  std::string operator()(std::int64_t value) const { return std::to_string(value); }
  std::string operator()(double value) const { return shortest_text(value); }
  std::string operator()(const std::string& value) const { return yaml_text(value); }
  std::string operator()(const std::vector<double>& value) const {
    return formatted("[{}]", listed(value, shortest_text));
  }
  std::string operator()(const std::vector<std::string>& value) const {
    return formatted("[{}]", listed(value, yaml_text));
  }
  std::string operator()(const std::map<std::string, std::string>& value) const {
    return formatted("{{{}}}", listed(value, [](const auto& entry) {
                       return formatted("{}: {}", entry.first, yaml_text(entry.second));
                     }));
  }
  std::string operator()(const std::vector<Record>& value) const {
    return formatted("[{}]", listed(value, record_text));
  }
};

}  // namespace

std::string shortest_text(double number) {
  if (std::isnan(number)) return "nan";  // whose sign means nothing
  constexpr double kPlain = 1e15;
  if (std::fabs(number) < kPlain && number == std::floor(number)) return formatted("{:.0f}", number);
  std::array<char, 32> text;
  char* const end = std::to_chars(text.data(), text.data() + text.size(), number).ptr;
  return std::string(text.data(), end);
}

// JSON's quotes are YAML's double quotes.
std::string yaml_text(const std::string& text) {
  if (is_plain(text)) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      quoted += formatted("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

std::string text_of(const Value& value) {
  return std::visit(TextOf{}, static_cast<const Value::variant&>(value));
}

bool read_number(const std::string& text, bool binary, double& number) {
  const char* begin = text.data();
  const char* const all = begin + text.size();
  if (begin != all && *begin == '+') ++begin;  // from_chars rejects a plus sign
  const auto [end, error] = from_chars(begin, all, number);
  if (error != std::errc{}) return false;
  const int power = power_of({end, static_cast<std::size_t>(all - end)}, binary);
  if (power < 0) return false;
  if (power > 0) number *= std::pow(binary ? 1024.0 : 1000.0, power);
  return std::isfinite(number);
}

}  // namespace driftmesh::job
