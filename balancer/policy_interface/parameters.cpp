#include <algorithm>
#include <sstream>
#include <system_error>

#include "base/from_chars.hpp"
#include "base/nearest_name.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/policy_parameters.hpp"

namespace driftmesh::balancer {
namespace {

// Parses all of `text` as a number; returns false if it is not one.
template <class T>
bool parse(const std::string& text, T& value) {
  const char* const end = text.data() + text.size();
  const auto result = from_chars(text.data(), end, value);
  return result.ec == std::errc() && result.ptr == end;
}

template <class T>
std::string range(T least, T most) {
  std::ostringstream text;
  text << "it must be a number from " << least << " to " << most;
  return text.str();
}

}  // namespace

void Parameters::fail(const std::string& name, const std::string& value, const std::string& next) const {
  throw InputError("policy " + policy_ + ": " + name + ": '" + value + "' cannot be used; " + next);
}

const std::string* Parameters::take(const std::string& name) {
  known_.push_back(name);
  const auto given = values_.find(name);
  return given == values_.end() ? nullptr : &given->second;
}

double Parameters::number(const std::string& name, double standard, double least, double most) {
  const std::string* const text = take(name);
  double value = standard;
  // A NaN is in no range.
  if (text && (!parse(*text, value) || !(value >= least && value <= most))) fail(name, *text, range(least, most));
  return value;
}

std::int64_t Parameters::integer(const std::string& name, std::int64_t standard, std::int64_t least,
                                 std::int64_t most) {
  const std::string* const text = take(name);
  std::int64_t value = standard;
  if (text && (!parse(*text, value) || value < least || value > most))
    fail(name, *text, "it must be a whole number from " + std::to_string(least) + " to " + std::to_string(most));
  return value;
}

bool Parameters::flag(const std::string& name, bool standard) {
  const std::string* const text = take(name);
  if (!text) return standard;
  if (*text != "true" && *text != "false") fail(name, *text, "it must be true or false");
  return *text == "true";
}

std::string Parameters::choice(const std::string& name, const std::vector<std::string>& choices) {
  const std::string* const text = take(name);
  if (!text) return choices.front();
  if (std::find(choices.begin(), choices.end(), *text) == choices.end())
    fail(name, *text, "the nearest choice is '" + nearest_name(*text, choices) + "'");
  return *text;
}

Parameters::Values Parameters::any_of(const std::vector<std::string>& names) {
  Values given;
  for (const std::string& name : names)
    if (const std::string* const text = take(name)) given[name] = *text;
  return given;
}

void Parameters::finish() const {
  for (const auto& [name, value] : values_)
    if (std::find(known_.begin(), known_.end(), name) == known_.end())
      throw InputError("policy " + policy_ + ": unknown parameter '" + name + "'; " +
                       (known_.empty() ? "it has none" : "the nearest one is '" + nearest_name(name, known_) + "'"));
}

}  // namespace driftmesh::balancer
