#include "base/formatted.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include "base/assert.hpp"

namespace driftmesh {
namespace {

/// What stands between ":" and "}".
struct Spec {
  char alignment = 0;  // '<', '>', or 0: texts left, numbers right
  bool zeros = false;
  std::size_t width = 0;
  int precision = -1;  // -1: as many digits as it takes
  char type = 0;       // 0: by the value
};

std::size_t number_at(std::string_view text, std::size_t& i) {
  std::size_t number = 0;
  for (; i < text.size() && text[i] >= '0' && text[i] <= '9'; ++i)
    number = 10 * number + static_cast<std::size_t>(text[i] - '0');
  return number;
}

Spec spec_of(std::string_view text) {
  Spec spec;
  std::size_t i = text.starts_with(':') ? 1 : 0;
  if (i < text.size() && (text[i] == '<' || text[i] == '>')) spec.alignment = text[i++];
  if (i < text.size() && text[i] == '0') spec.zeros = true;
  spec.width = number_at(text, i);
  if (i < text.size() && text[i] == '.') spec.precision = static_cast<int>(number_at(text, ++i));
  if (i < text.size()) spec.type = text[i++];
  DM_ASSERT(i == text.size());
  return spec;
}

/// The text that `write(begin, end)` puts into memory, as std::to_chars does.
template <class Write>
std::string written(const Write& write) {
  std::array<char, 512> text;  // the largest double has 309 digits
  return {text.data(), write(text.data(), text.data() + text.size()).ptr};
}

/// Like printf's %g with the fewest digits that read back to the same number.
std::string shortest(double value) {
  std::string text =
      written([&](char* begin, char* end) { return std::to_chars(begin, end, value, std::chars_format::scientific); });
  const std::size_t e = text.find('e');
  if (e == std::string::npos) return text;               // no number, or infinite
  const int exponent = std::atoi(text.c_str() + e + 1);  // NOLINT(cert-err34-c): to_chars wrote it
  constexpr int kSmallest = -4, kLargest = 15;
  if (exponent < kSmallest || exponent > kLargest) return text;
  return written([&](char* begin, char* end) { return std::to_chars(begin, end, value, std::chars_format::fixed); });
}

struct ValueText {
  const Spec& spec;

  std::string operator()(std::string_view value) const { return std::string(value); }
  std::string operator()(double value) const {
    if (std::isnan(value)) return "nan";  // whose sign means nothing
    if (spec.precision < 0) return shortest(value);
    const auto format = spec.type == 'f' ? std::chars_format::fixed : std::chars_format::general;
    return written([&](char* begin, char* end) { return std::to_chars(begin, end, value, format, spec.precision); });
  }
  template <std::integral Integer>
  std::string operator()(Integer value) const {
    const int base = spec.type == 'x' ? 16 : 10;
    return written([&](char* begin, char* end) { return std::to_chars(begin, end, value, base); });
  }
};

void append(std::string& text, const Spec& spec, const FormatValue& value) {
  const std::string shown = std::visit(ValueText{spec}, value);
  const std::size_t space = spec.width > shown.size() ? spec.width - shown.size() : 0;
  const bool is_text = std::holds_alternative<std::string_view>(value);
  const bool left = spec.alignment == '<' || (spec.alignment == 0 && is_text);
  const bool zeros = spec.zeros && spec.alignment == 0 && !is_text;
  const std::size_t sign = zeros && shown.starts_with('-') ? 1 : 0;
  text.append(shown, 0, sign);
  if (!left) text.append(space, zeros ? '0' : ' ');
  text.append(shown, sign);
  if (left) text.append(space, ' ');
}

}  // namespace

std::string format_values(std::string_view pattern, std::span<const FormatValue> values) {
  std::string text;
  std::size_t next = 0;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    const char c = pattern[i];
    const bool doubled = (c == '{' || c == '}') && i + 1 < pattern.size() && pattern[i + 1] == c;
    if (doubled) ++i;
    if (c != '{' || doubled) {
      text += c;
      continue;
    }
    const std::size_t end = pattern.find('}', i);
    append(text, spec_of(pattern.substr(i + 1, end - i - 1)), values[next++]);
    i = end;
  }
  return text;
}

std::string joined(std::span<const std::string> texts, std::string_view separator) {
  std::string all;
  for (const std::string& text : texts) {
    if (&text != texts.data()) all += separator;
    all += text;
  }
  return all;
}

}  // namespace driftmesh
