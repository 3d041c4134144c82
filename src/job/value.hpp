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

/// A text in YAML, in quotes if it needs them.
[[nodiscard]] std::string yaml_text(const std::string& text);

/// Reads a number that may be followed by a unit k, M, G or T: the powers of 1000, or of 1024 if `binary` (then B or iB
/// may follow). Returns false for anything else, and if the number is not finite.
[[nodiscard]] bool read_number(const std::string& text, bool binary, double& number);

}  // namespace driftmesh::job
