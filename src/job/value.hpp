#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "driftmesh/error.hpp"

namespace driftmesh::job {

struct Value;

/// Names and their values, in the order in which they are written.
using Record = std::vector<std::pair<std::string, Value>>;

/// The value of a key. Which alternative it holds follows from the key's kind.
struct Value : std::variant<bool, std::int64_t, double, std::string, std::vector<double>, std::vector<std::string>,
                            std::map<std::string, std::string>, std::vector<Record>> {
  using variant::variant;

  template <class T>
  [[nodiscard]] const T& as() const {
    return std::get<T>(*this);
  }
};

/// A value in one line of YAML that reads back as the same: 0.5, true, "[2, 4]", "{a: b}".
[[nodiscard]] std::string text_of(const Value& value);

/// The shortest decimal form of a number that reads back as the same.
[[nodiscard]] std::string shortest_text(double number);

/// A text as YAML reads it back: in quotes where it needs them.
[[nodiscard]] std::string yaml_text(const std::string& text);

/// The number that `text` says, with a unit k, M, G or T behind it, or none: thousands to the power of 1 to 4, of 1024
/// each if `binary` (then a B or iB may follow). Returns false for anything else, and for what is not finite.
[[nodiscard]] bool read_number(const std::string& text, bool binary, double& number);

}  // namespace driftmesh::job
