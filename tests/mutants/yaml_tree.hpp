#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mutants/fields.hpp"

namespace driftmesh::mutants {

/// A value in a YAML file: a text, a list, or a table.
struct YamlNode {
  enum class Kind { kText, kList, kTable };
  Kind kind = Kind::kText;
  std::string text;
  std::vector<YamlNode> items;
  std::vector<std::pair<std::string, YamlNode>> entries;
};

/// The table in a file of the simplest YAML: tables by indentation, lists and tables in brackets, plain words, and
/// quotes without escapes; nothing for any other. Throws Undeclared for a key that is given twice.
[[nodiscard]] std::optional<YamlNode> yaml_tree(std::string_view text);

}  // namespace driftmesh::mutants
