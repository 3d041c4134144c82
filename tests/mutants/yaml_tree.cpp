#include "mutants/yaml_tree.hpp"

#include <algorithm>

namespace driftmesh::mutants {
namespace {

/// What this reader does not know. The file may be valid.
class Unfamiliar : public std::runtime_error {
 public:
  Unfamiliar() : std::runtime_error("YAML that is not of the simplest") {}
};

struct Line {
  std::size_t indentation;
  std::string_view text;
};

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

std::string_view without_comment(std::string_view line) {
  char quote = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (quote != 0 && line[i] == quote)
      quote = 0;
    else if (quote == 0 && (line[i] == '"' || line[i] == '\''))
      quote = line[i];
    else if (quote == 0 && line[i] == '#' && (i == 0 || line[i - 1] == ' '))
      return line.substr(0, i);
  }
  return line;
}

std::vector<Line> lines_of(std::string_view text) {
  std::vector<Line> lines;
  while (!text.empty()) {
    const std::string_view whole = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(whole.size() + 1, text.size()));
    const std::string_view line = without_comment(whole);
    const std::size_t indentation = line.find_first_not_of(' ');
    if (indentation == std::string_view::npos) continue;
    if (std::ranges::any_of(line, [](char c) { return c < ' ' || c > '~' || c == '\\'; })) throw Unfamiliar();
    lines.push_back({indentation, trimmed(line)});
  }
  return lines;
}

/// Values on one line.
class Flow {
 public:
  explicit Flow(std::string_view text) : text_(text) {}

  YamlNode whole() {
    YamlNode node = take("");
    if (!trimmed(text_.substr(at_)).empty()) throw Unfamiliar();
    return node;
  }

 private:
  /// A value that ends before one of `ends`, or at the end of the line.
  YamlNode take(std::string_view ends) {
    skip_blanks();
    YamlNode node;
    if (here() == '[') {
      node.kind = YamlNode::Kind::kList;
      take_items(']', [&] { node.items.push_back(take(",]")); });
    } else if (here() == '{') {
      node.kind = YamlNode::Kind::kTable;
      take_items('}', [&] {
        const std::string key = take(":,}").text;
        if (here() != ':') throw Unfamiliar();
        ++at_;
        node.entries.emplace_back(key, take(",}"));
      });
    } else {
      node.text = word(ends);
    }
    return node;
  }

  template <class TakeItem>
  void take_items(char end, const TakeItem& take_item) {
    ++at_;
    for (skip_blanks(); here() != end; skip_blanks()) {
      take_item();
      skip_blanks();
      if (here() != end && here() != ',') throw Unfamiliar();
      if (here() == ',') ++at_;
    }
    ++at_;
  }

  std::string word(std::string_view ends) {
    const char quote = here();
    if (quote == '"' || quote == '\'') {
      const std::size_t end = text_.find(quote, at_ + 1);
      if (end == std::string_view::npos) throw Unfamiliar();
      const std::string_view inside = text_.substr(at_ + 1, end - at_ - 1);
      at_ = end + 1;
      return std::string(inside);
    }
    const std::size_t end = std::min(text_.find_first_of(ends, at_), text_.size());
    const std::string_view plain = trimmed(text_.substr(at_, end - at_));
    const bool is_special =
        plain.empty() || plain == "null" || std::string_view("-?:").find(plain) != std::string_view::npos ||
        std::string_view("&*!|>%@`?#{}[]\"'~ABCDEFGHIJKLMNOPQRSTUVWXYZ").find(plain[0]) != std::string_view::npos;
    if (is_special || plain.find_first_of("{}[]\"'") != std::string_view::npos ||
        plain.find(": ") != std::string_view::npos || plain.ends_with(':') || plain.starts_with("- "))
      throw Unfamiliar();
    at_ = end;
    return std::string(plain);
  }

  [[nodiscard]] char here() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  void skip_blanks() {
    while (here() == ' ') ++at_;
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

class Block {
 public:
  explicit Block(std::vector<Line> lines) : lines_(std::move(lines)) {}

  YamlNode whole() {
    YamlNode table;
    table.kind = YamlNode::Kind::kTable;
    if (!lines_.empty()) table = take(lines_[0].indentation);
    if (at_ != lines_.size()) throw Unfamiliar();
    return table;
  }

 private:
  YamlNode take(std::size_t indentation) {
    const bool is_list = lines_[at_].text.starts_with("- ");
    YamlNode node;
    node.kind = is_list ? YamlNode::Kind::kList : YamlNode::Kind::kTable;
    while (at_ < lines_.size() && lines_[at_].indentation == indentation) {
      const std::string_view line = lines_[at_++].text;
      if (line.starts_with("- ") != is_list) throw Unfamiliar();
      if (is_list)
        node.items.push_back(Flow(line.substr(2)).whole());
      else
        take_entry(line, indentation, node);
      if (at_ < lines_.size() && lines_[at_].indentation > indentation) throw Unfamiliar();
    }
    return node;
  }

  void take_entry(std::string_view line, std::size_t indentation, YamlNode& table) {
    const std::size_t colon = std::min(line.find(": "), line.ends_with(':') ? line.size() - 1 : line.size());
    if (colon == line.size()) throw Unfamiliar();
    const std::string key(trimmed(line.substr(0, colon)));
    if (key.empty() || key.find_first_not_of("abcdefghijklmnopqrstuvwxyz-.0123456789") != std::string::npos)
      throw Unfamiliar();
    for (const auto& [other, value] : table.entries)
      if (other == key) throw Undeclared("a key is given twice");
    const std::string_view value = trimmed(line.substr(colon + 1));
    if (!value.empty()) {
      table.entries.emplace_back(key, Flow(value).whole());
      return;
    }
    if (at_ == lines_.size() || lines_[at_].indentation <= indentation) throw Unfamiliar();
    YamlNode below = take(lines_[at_].indentation);
    table.entries.emplace_back(key, std::move(below));
  }

  std::vector<Line> lines_;
  std::size_t at_ = 0;
};

}  // namespace

std::optional<YamlNode> yaml_tree(std::string_view text) {
  try {
    return Block(lines_of(text)).whole();
  } catch (const Unfamiliar&) {
    return std::nullopt;
  }
}

}  // namespace driftmesh::mutants
