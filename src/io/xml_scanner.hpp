#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace driftmesh {

/// One tag of an XML text: <name key="value" ...>, <name .../> or </name>.
struct XmlTag {
  std::string_view name;
  std::map<std::string_view, std::string_view> attributes;
  bool opens = true;        ///< false for </name>
  bool closes = false;      ///< true for </name> and <name .../>
  std::string_view before;  ///< the text between the tag before this one and this one; empty if it is blank
  std::vector<std::string_view> parents;  ///< the elements that this one is in, from the root on
  std::size_t line = 0;

  /// The attribute's value, or `otherwise` if the tag has none of that name.
  [[nodiscard]] std::string_view attribute(std::string_view key, std::string_view otherwise = {}) const;
  /// The element that the text before the tag is in; empty outside of the root.
  [[nodiscard]] std::string_view around_text() const;
};

/// Reads the tags of an XML text one by one: the part of XML that mesh headers use (no entities, no CDATA).
/// Comments and processing instructions are skipped. There is one root, what is opened must be closed in turn, and
/// no attribute is given twice.
class XmlScanner {
 public:
  XmlScanner(const std::string& file, std::string_view text) : file_(file), text_(text) {}

  /// Reads the next tag; false at the end of the text. Error: InputError if the text is not XML.
  bool next(XmlTag& tag);
  /// Where the scanner stands: just after the last tag.
  [[nodiscard]] std::size_t position() const { return position_; }

 private:
  [[noreturn]] void fail(const std::string& what) const;
  bool skip_to_tag(XmlTag& tag);
  void take_text(XmlTag& tag, std::size_t end);
  void skip_past(std::string_view end);
  void skip_blanks();
  std::string_view take_name();
  std::string_view take_quoted();
  void take_attributes(XmlTag& tag);
  void take_nesting(XmlTag& tag);
  void advance_to(std::size_t position);

  const std::string& file_;
  std::string_view text_;
  std::vector<std::string_view> open_;  // elements, from the root on
  bool has_root_ = false;
  std::size_t position_ = 0;
  std::size_t line_ = 1;
};

}  // namespace driftmesh
