#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

namespace driftmesh {

/// A value that a text shows.
using FormatValue = std::variant<std::int64_t, std::uint64_t, double, std::string_view>;

template <class T>
[[nodiscard]] FormatValue format_value(const T& value) {
  if constexpr (std::unsigned_integral<T>)
    return static_cast<std::uint64_t>(value);
  else if constexpr (std::integral<T>)
    return static_cast<std::int64_t>(value);
  else if constexpr (std::floating_point<T>)
    return static_cast<double>(value);
  else
    return std::string_view(value);
}

/// Does what formatted() promises, whatever the types were.
[[nodiscard]] std::string format_values(std::string_view pattern, std::span<const FormatValue> values);

/// A pattern with a place for each value, or it does not compile.
template <class... Values>
class Pattern {
 public:
  template <class Text>
  requires std::convertible_to<const Text&, std::string_view>
  consteval Pattern(const Text& text) : text_(text) {  // NOLINT(google-explicit-constructor): a literal is a pattern
    if (places(text_) != sizeof...(Values)) throw "the pattern must have one place for each value";
  }
  [[nodiscard]] std::string_view text() const { return text_; }

 private:
  static constexpr std::size_t places(std::string_view text) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (text[i] != '{') continue;
      if (i + 1 < text.size() && text[i + 1] == '{')
        ++i;
      else
        ++count;
    }
    return count;
  }

  std::string_view text_;
};

/// The pattern with the values in its places, as std::format does it: "{}", or "{:" alignment (< or >), 0, width,
/// .precision, type "}", of which all may be absent; the type is g or f of a number with a fraction, x of a whole one.
/// "{{" and "}}" are braces. A number without a precision reads back to the same bits.
template <class... Values>
[[nodiscard]] std::string formatted(Pattern<std::type_identity_t<Values>...> pattern, const Values&... values) {
  const std::vector<FormatValue> list{format_value(values)...};
  return format_values(pattern.text(), list);
}

/// Appends to a text what formatted() returns.
template <class... Values>
void append_formatted(std::string& text, Pattern<std::type_identity_t<Values>...> pattern, const Values&... values) {
  text += formatted(pattern, values...);
}

/// The texts with a separator between them.
[[nodiscard]] std::string joined(std::span<const std::string> texts, std::string_view separator);

}  // namespace driftmesh
