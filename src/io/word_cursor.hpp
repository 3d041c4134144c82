#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "driftmesh/error.hpp"
#include "io/byte_cursor.hpp"
#include "io/number_of_word.hpp"
#include "io/read_checks.hpp"
#include "io/tag_comments.hpp"

namespace driftmesh {

/// The next step for what no mesh here can have.
inline constexpr const char* kTrianglesOnly = "driftmesh reads planar meshes of straight triangles";

/// A text file as words between blanks and ends of lines; '#' begins a comment that reaches to the end of its line.
class WordCursor {
 public:
  WordCursor(const std::string& file, std::string_view text) : cursor_(file, text) {}

  /// The next word; empty at the end of the file.
  std::string_view word() {
    if (ahead_) return *std::exchange(ahead_, std::nullopt);
    for (cursor_.skip_blanks(); cursor_.rest().starts_with('#'); cursor_.skip_blanks())
      comments_.read(cursor_.take_line().substr(1));
    return cursor_.take_bytes(length_of_word(), 1, "a word");
  }

  /// The same without taking it.
  std::string_view peek() {
    ahead_ = word();
    return *ahead_;
  }

  template <class Number>
  Number number(const char* what) {
    const std::string_view text = word();
    const auto value = number_of<Number>(text);
    if (!value)
      fail(text.empty() ? std::string("ends where ") + what + " is expected"
                        : "has '" + std::string(text.substr(0, 30)) + "' in place of " + what);
    return *value;
  }

  /// A number of things that take at least two characters each.
  std::size_t count(const char* what) {
    const auto found = number<std::int64_t>("a count");
    if (found < 0 || static_cast<std::uint64_t>(found) > cursor_.remaining() / 2 + 1)
      fail("announces " + std::to_string(found) + " " + what + ", more than the file can hold");
    return static_cast<std::size_t>(found);
  }

  [[nodiscard]] const TagComments& comments() const { return comments_; }

  [[noreturn]] void fail(const std::string& what, const char* next = kDamaged) const {
    throw InputError(cursor_.place(), what, next);
  }

 private:
  [[nodiscard]] std::size_t length_of_word() const {
    const std::string_view rest = cursor_.rest();
    std::size_t length = 0;
    while (length < rest.size() && !ByteCursor::is_blank(rest[length]) && rest[length] != '#') ++length;
    return length;
  }

  ByteCursor cursor_;
  std::optional<std::string_view> ahead_;  // what peek() has seen
  TagComments comments_;
};

}  // namespace driftmesh
