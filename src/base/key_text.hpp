#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "base/bytes.hpp"
#include "base/formatted.hpp"

namespace driftmesh {

/// What an entry point (the command line, a file, the library, Python) calls a key, given its full name: "--area" for
/// "bounds.area".
using Words = std::function<std::string(const std::string& key)>;

/// The full names of keys, which experiments use.
[[nodiscard]] inline std::string full_name(const std::string& key) {
  return key;
}

/// A text that refers to keys. It is kept in parts until an entry point puts it into its own words.
class KeyText {
 public:
  struct Part {
    std::string text;
    bool is_key = false;
    friend bool operator==(const Part&, const Part&) = default;
  };

  KeyText() = default;
  /// A text without keys, whatever it contains.
  KeyText(std::string text);  // NOLINT(google-explicit-constructor)
  /// A literal that refers to keys by their full names in braces: "remove it or {input.file}".
  template <std::size_t N>
  KeyText(const char (&pattern)[N]) : KeyText(of(pattern)) {}  // NOLINT(google-explicit-constructor)

  /// Likewise; {} stands for the next of the values, which are numbers or texts, among them KeyTexts.
  template <class... Values>
  [[nodiscard]] static KeyText of(std::string_view pattern, const Values&... values) {
    return filled(pattern, std::array<KeyText, sizeof...(Values)>{value(values)...});
  }

  /// The key alone.
  [[nodiscard]] static KeyText key(std::string_view name) {
    KeyText made;
    made.add(name, true);
    return made;
  }

  [[nodiscard]] bool empty() const { return parts_.empty(); }
  [[nodiscard]] const std::vector<Part>& parts() const { return parts_; }
  [[nodiscard]] std::string in(const Words& words) const;

  void write(ByteWriter& writer) const;
  [[nodiscard]] static KeyText read(ByteReader& reader);

  friend bool operator==(const KeyText&, const KeyText&) = default;

 private:
  template <class Value>
  static KeyText value(const Value& value) {
    if constexpr (std::is_arithmetic_v<Value>)
      return KeyText(formatted("{}", value));
    else if constexpr (std::is_same_v<Value, KeyText>)
      return value;
    else
      return KeyText(std::string(value));
  }
  static KeyText filled(std::string_view pattern, std::span<const KeyText> values);
  void add(std::string_view text, bool is_key);

  std::vector<Part> parts_;
};

}  // namespace driftmesh
