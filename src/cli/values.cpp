#include "cli/values.hpp"

#include <charconv>
#include <cmath>
#include <limits>
#include <type_traits>

namespace driftmesh::cli {
namespace {

std::string shortest_text(double number) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, number).ptr};
}

/// A limit of values of this type. The nearest double may be beyond the greatest integer.
template <class Number>
std::string text_of_limit(double limit) {
  if constexpr (std::is_integral_v<Number>) {
    using Limits = std::numeric_limits<Number>;
    if (limit >= static_cast<double>(Limits::max())) return std::to_string(Limits::max());
    if (limit <= static_cast<double>(Limits::min())) return std::to_string(Limits::min());
  }
  return shortest_text(limit);
}

template <class Number>
std::string words_of(const Range& range) {
  const std::string least = text_of_limit<Number>(range.least);
  if (std::isfinite(range.most))
    return (range.above ? "above " : "from ") + least + (range.above ? " and at most " : " to ") +
           text_of_limit<Number>(range.most);
  return range.above ? "above " + least : "at least " + least;
}

/// Whether a text is a whole number, of any length.
bool is_whole(const std::string& text) {
  const std::size_t digits = text.find_first_not_of("+-") == 1 ? 1 : 0;
  return digits < text.size() && text.find_first_not_of("0123456789", digits) == std::string::npos;
}

template <class Number>
Number read(const std::string& text, const Range& range, const char* what) {
  Number value{};
  const char* const begin = text.data() + (text.starts_with('+') ? 1 : 0);  // from_chars knows no plus
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(begin, end, value);
  const auto number = static_cast<double>(value);
  const bool is_read = error == std::errc{} && rest == end && std::isfinite(number);
  const bool is_beyond = !is_read && std::is_integral_v<Number> && is_whole(text);  // what the type holds
  if (!is_read && !is_beyond) throw UsageError("is '" + text + "', which is not " + what);
  if (is_beyond || number < range.least || number > range.most || (range.above && number == range.least))
    throw UsageError("is " + text + "; it must be " + words_of<Number>(range));
  return value;
}

}  // namespace

double read_number(const std::string& text, const Range& range) {
  return read<double>(text, range, "a number");
}

template <std::integral Number>
Number read_integer(const std::string& text, const Range& range) {
  return read<Number>(text, range, "a whole number");
}

template std::int64_t read_integer(const std::string& text, const Range& range);
template std::uint64_t read_integer(const std::string& text, const Range& range);

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
