#include "mutants/xml_tree.hpp"

#include <algorithm>
#include <utility>

namespace driftmesh::mutants {
namespace {

bool is_blank(std::string_view text) {
  return text.find_first_not_of(kXmlBlanks) == std::string_view::npos;
}

/// The characters that stand for themselves only when escaped.
std::string unescaped(std::string_view text) {
  static const std::map<std::string_view, char> kNames{
      {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}, {"&amp;", '&'}};
  std::string result;
  while (!text.empty()) {
    const std::string_view name = text.substr(0, text.find(';') + 1);
    const auto found = text[0] == '&' ? kNames.find(name) : kNames.end();
    result += found == kNames.end() ? text[0] : found->second;
    text.remove_prefix(found == kNames.end() ? 1 : name.size());
  }
  return result;
}

class Parser {
 public:
  Parser(std::string_view bytes, Fields& fields) : bytes_(bytes), fields_(fields) {}

  XmlTree parse() {
    while (!is_complete_) {
      take_text();
      if (skips("<?", "?>") || skips("<!--", "-->") || skips("<!", ">")) continue;
      expect("<");
      if (takes("/"))
        close(take_name());
      else if (open())
        break;
    }
    if (!is_blank(bytes_.substr(at_)) && tree_.appended.data() == nullptr) throw Undeclared("more behind the root");
    return std::move(tree_);
  }

 private:
  bool takes(std::string_view word) {
    const bool there = bytes_.substr(at_).starts_with(word);
    if (there) at_ += word.size();
    return there;
  }
  void expect(std::string_view word) {
    if (!takes(word)) throw Undeclared("XML lacks a " + std::string(word));
  }
  bool skips(std::string_view begin, std::string_view end) {
    if (!takes(begin)) return false;
    const std::size_t found = bytes_.find(end, at_);
    if (found == std::string_view::npos) throw Undeclared("XML lacks a " + std::string(end));
    at_ = found + end.size();
    return true;
  }
  void skip_blanks() { at_ = std::min(bytes_.find_first_not_of(kXmlBlanks, at_), bytes_.size()); }

  void take_text() {
    const std::size_t end = std::min(bytes_.find('<', at_), bytes_.size());
    const std::string_view found = bytes_.substr(at_, end - at_);
    at_ = end;
    if (end == bytes_.size()) throw Undeclared("XML ends early");
    if (is_blank(found)) return;
    const auto is_array = [](const Element& element) { return element.name == "DataArray" || element.name == "Array"; };
    if (std::ranges::none_of(open_, is_array) || !open_.back().text.empty()) throw Undeclared("text between elements");
    open_.back().text = found;
  }

  std::string take_name() {
    const std::size_t end = std::min(bytes_.find_first_of(" \t\r\n=/><\"'", at_), bytes_.size());
    const std::string_view name = bytes_.substr(at_, end - at_);
    if (name.empty()) throw Undeclared("XML lacks a name");
    at_ = end;
    return std::string(name);
  }

  /// Whether it was the tag behind which there is no XML.
  bool open() {
    Element element;
    element.name = take_name();
    for (skip_blanks(); !bytes_.substr(at_).starts_with(">") && !bytes_.substr(at_).starts_with("/>"); skip_blanks())
      take_attribute(element);
    const bool is_closed = takes("/");
    expect(">");
    if (element.name == "AppendedData" && !is_closed) {
      if (open_.size() != 1) throw Undeclared("AppendedData in a wrong place");
      tree_.appended = bytes_.substr(at_);
      open_.back().children.push_back(std::move(element));
      tree_.root = std::move(open_.back());
      return true;
    }
    open_.push_back(std::move(element));
    if (is_closed) leave();
    return false;
  }

  void take_attribute(Element& element) {
    const std::string key = take_name();
    skip_blanks();
    expect("=");
    skip_blanks();
    const std::string quote = bytes_.substr(at_).starts_with("'") ? "'" : "\"";
    expect(quote);
    const std::size_t end = bytes_.find(quote, at_);
    if (end == std::string_view::npos) throw Undeclared("a value has no end");
    fields_.push_back({at_, end - at_});
    if (!element.attributes.emplace(key, unescaped(bytes_.substr(at_, end - at_))).second)
      throw Undeclared("an attribute is given twice");
    at_ = end + 1;
  }

  void close(const std::string& name) {
    skip_blanks();
    expect(">");
    if (open_.empty() || open_.back().name != name) throw Undeclared("tags that do not match");
    leave();
  }

  void leave() {
    Element element = std::move(open_.back());
    open_.pop_back();
    is_complete_ = open_.empty();
    if (is_complete_)
      tree_.root = std::move(element);
    else
      open_.back().children.push_back(std::move(element));
  }

  std::string_view bytes_;
  Fields& fields_;
  std::size_t at_ = 0;
  std::vector<Element> open_;
  bool is_complete_ = false;
  XmlTree tree_;
};

}  // namespace

std::string Element::attribute(const std::string& key, const std::string& otherwise) const {
  const auto found = attributes.find(key);
  return found == attributes.end() ? otherwise : found->second;
}

std::uint64_t Element::count(const std::string& key) const {
  const std::optional<std::int64_t> value = whole_number(attribute(key));
  if (!value || *value < 0) throw Undeclared(key + " is no count");
  return static_cast<std::uint64_t>(*value);
}

const Element& Element::only(const std::string& child) const {
  const Element* found = nullptr;
  for (const Element& c : children) {
    if (c.name != child) continue;
    if (found != nullptr) throw Undeclared("two elements " + child);
    found = &c;
  }
  if (found == nullptr) throw Undeclared("no element " + child);
  return *found;
}

XmlTree xml_tree(std::string_view bytes, Fields& fields) {
  return Parser(bytes, fields).parse();
}

}  // namespace driftmesh::mutants
