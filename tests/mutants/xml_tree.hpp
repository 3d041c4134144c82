#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "mutants/fields.hpp"

namespace driftmesh::mutants {

/// What stands between words and numbers in XML.
inline constexpr std::string_view kXmlBlanks = " \t\r\n";

/// An element of an XML file.
struct Element {
  std::string name;
  std::map<std::string, std::string> attributes;
  std::vector<Element> children;
  std::string_view text;  ///< between its tags, not in a child; it must be in one part

  [[nodiscard]] std::string attribute(const std::string& key, const std::string& otherwise = "") const;
  /// A whole number from 0 on. Throws Undeclared.
  [[nodiscard]] std::uint64_t count(const std::string& key) const;
  /// The only child of this name. Throws Undeclared.
  [[nodiscard]] const Element& only(const std::string& child) const;
};

/// A well-formed file with one root, and with text in arrays only. What follows the tag <AppendedData> is no XML and
/// stays as it is.
struct XmlTree {
  Element root;
  std::string_view appended{};  ///< all behind the tag; without data() if there is no such tag
};

/// Notes the values of attributes in `fields`. Throws Undeclared.
[[nodiscard]] XmlTree xml_tree(std::string_view bytes, Fields& fields);

}  // namespace driftmesh::mutants
