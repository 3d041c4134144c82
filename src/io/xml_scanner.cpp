#include "io/xml_scanner.hpp"

#include <algorithm>
#include <utility>

#include "driftmesh/error.hpp"

namespace driftmesh {
namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

bool ends_name(char c) {
  return is_blank(c) || c == '=' || c == '/' || c == '>' || c == '<' || c == '"' || c == '\'';
}

}  // namespace

std::string_view XmlTag::attribute(std::string_view key, std::string_view otherwise) const {
  const auto found = attributes.find(key);
  return found == attributes.end() ? otherwise : found->second;
}

std::string_view XmlTag::around_text() const {
  if (!opens) return name;
  return parents.empty() ? std::string_view() : parents.back();
}

bool XmlScanner::next(XmlTag& tag) {
  XmlTag found;
  if (!skip_to_tag(found)) return false;
  tag = std::move(found);
  tag.line = line_;
  advance_to(position_ + 1);
  if (position_ < text_.size() && text_[position_] == '/') {
    tag.opens = false;
    tag.closes = true;
    advance_to(position_ + 1);
  }
  tag.name = take_name();
  take_attributes(tag);
  take_nesting(tag);
  return true;
}

void XmlScanner::take_nesting(XmlTag& tag) {
  if (tag.opens) {
    if (open_.empty() && std::exchange(has_root_, true)) fail("there is a second root <" + std::string(tag.name) + ">");
  } else {
    if (open_.empty() || open_.back() != tag.name)
      fail("</" + std::string(tag.name) + "> does not close the element that was opened last");
    open_.pop_back();
  }
  tag.parents = open_;
  if (!tag.closes) open_.push_back(tag.name);
}

void XmlScanner::take_text(XmlTag& tag, std::size_t end) {
  const std::string_view text = text_.substr(position_, end - position_);
  advance_to(end);
  if (std::all_of(text.begin(), text.end(), is_blank)) return;
  if (!tag.before.empty()) fail("a text is divided by a comment");
  tag.before = text;
}

bool XmlScanner::skip_to_tag(XmlTag& tag) {
  while (true) {
    take_text(tag, std::min(text_.find('<', position_), text_.size()));
    const std::string_view rest = text_.substr(position_);
    if (rest.empty()) return false;
    if (rest.starts_with("<?"))
      skip_past("?>");
    else if (rest.starts_with("<!--"))
      skip_past("-->");
    else if (rest.starts_with("<!"))
      skip_past(">");
    else
      return true;
  }
}

void XmlScanner::skip_past(std::string_view end) {
  const std::size_t found = text_.find(end, position_);
  if (found == std::string_view::npos) fail(std::string("'").append(end).append("' is missing"));
  advance_to(found + end.size());
}

void XmlScanner::skip_blanks() {
  std::size_t position = position_;
  while (position < text_.size() && is_blank(text_[position])) ++position;
  advance_to(position);
}

std::string_view XmlScanner::take_name() {
  std::size_t end = position_;
  while (end < text_.size() && !ends_name(text_[end])) ++end;
  const std::string_view name = text_.substr(position_, end - position_);
  if (name.empty()) fail("a name is missing");
  advance_to(end);
  return name;
}

std::string_view XmlScanner::take_quoted() {
  const char quote = position_ < text_.size() ? text_[position_] : '\0';
  if (quote != '"' && quote != '\'') fail("a value in quotes is missing");
  const std::size_t end = text_.find(quote, position_ + 1);
  if (end == std::string_view::npos) fail("a closing quote is missing");
  const std::string_view value = text_.substr(position_ + 1, end - position_ - 1);
  advance_to(end + 1);
  return value;
}

void XmlScanner::take_attributes(XmlTag& tag) {
  while (true) {
    skip_blanks();
    const std::string_view rest = text_.substr(position_);
    if (rest.starts_with(">") || rest.starts_with("/>")) {
      if (rest.front() == '/') tag.closes = true;
      advance_to(position_ + (rest.front() == '/' ? 2 : 1));
      return;
    }
    const std::string_view key = take_name();
    skip_blanks();
    if (!text_.substr(position_).starts_with("=")) fail(std::string("'=' is missing after ").append(key));
    advance_to(position_ + 1);
    skip_blanks();
    if (!tag.attributes.emplace(key, take_quoted()).second) fail(std::string(key).append(" is given twice in a tag"));
  }
}

void XmlScanner::advance_to(std::size_t position) {
  const auto begin = text_.begin();
  line_ += static_cast<std::size_t>(
      std::count(begin + static_cast<std::ptrdiff_t>(position_), begin + static_cast<std::ptrdiff_t>(position), '\n'));
  position_ = position;
}

void XmlScanner::fail(const std::string& what) const {
  throw InputError({file_, line_}, "not XML: " + what, "is this a .vtu file, and complete?");
}

}  // namespace driftmesh
