#include "cli/values.hpp"

#include <charconv>
#include <cmath>
#include <sstream>

namespace driftmesh::cli {
namespace {

std::string shortest_text(double number) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, number).ptr};
}

std::string words_of(const Range& range) {
  const std::string least = shortest_text(range.least);
  if (std::isfinite(range.most))
    return (range.above ? "above " : "from ") + least + (range.above ? " and at most " : " to ") +
           shortest_text(range.most);
  return range.above ? "above " + least : "at least " + least;
}

template <class Number>
Number read(const std::string& text, const Range& range, const char* what) {
  Number value{};
  const char* const begin = text.data() + (text.starts_with('+') ? 1 : 0);  // from_chars knows no plus
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(begin, end, value);
  const auto number = static_cast<double>(value);
  if (error != std::errc{} || rest != end || !std::isfinite(number))
    throw UsageError("is '" + text + "', which is not " + what);
  if (number < range.least || number > range.most || (range.above && number == range.least))
    throw UsageError("is " + text + "; it must be " + words_of(range));
  return value;
}

}  // namespace

double read_number(const std::string& text, const Range& range) {
  return read<double>(text, range, "a number");
}

std::int64_t read_integer(const std::string& text, const Range& range) {
  return read<std::int64_t>(text, range, "a whole number");
}

Take into(std::string& to) {
  return [&to](const std::string& text) {
    if (text.empty()) throw UsageError("is empty; give it a value, or leave it out");
    to = text;
  };
}

std::vector<std::string> separated(const std::string& text) {
  std::vector<std::string> items;
  for (std::size_t begin = 0, end = 0; end != std::string::npos; begin = end + 1) {
    end = text.find(',', begin);
    items.push_back(text.substr(begin, end - begin));
  }
  return items;
}

}  // namespace driftmesh::cli
