#include "mutants/fields.hpp"

#include <cerrno>
#include <cstdlib>
#include <limits>

namespace driftmesh::mutants {
namespace {

constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::string_view kIgnored = " \t\r\n\v\f";

}  // namespace

Fields text_fields(std::string_view text) {
  constexpr std::string_view kBetween = " \t\r\n\v\f,:=<>\"'[]{}";
  Fields fields;
  for (std::size_t begin = 0; (begin = text.find_first_not_of(kBetween, begin)) != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(kBetween, begin), text.size());
    fields.push_back({begin, end - begin});
    begin = end;
  }
  return fields;
}

std::optional<std::int64_t> whole_number(std::string_view text) {
  const std::size_t sign = !text.empty() && (text[0] == '-' || text[0] == '+') ? 1 : 0;
  if (text.size() == sign || text.find_first_not_of("0123456789", sign) != std::string_view::npos) return std::nullopt;
  errno = 0;
  const long long value = std::strtoll(std::string(text).c_str(), nullptr, 10);
  if (errno != 0) return std::nullopt;
  return value;
}

std::optional<double> real_number(std::string_view text) {
  const std::string copy(text);
  for (const double sign : {1.0, -1.0})
    for (const double special : {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
      const std::string name = special == special ? "inf" : "nan";
      if (copy == (sign < 0 ? "-" + name : name)) return sign * special;
    }
  if (copy.empty() || copy.find_first_not_of("0123456789.eE+-") != std::string::npos) return std::nullopt;
  char* end = nullptr;
  const double value = std::strtod(copy.c_str(), &end);
  if (end != copy.c_str() + copy.size()) return std::nullopt;
  return value;
}

std::string to_base64(std::string_view bytes) {
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t here = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (k < here ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += k <= here ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

void Base64Text::decode_four() {
  std::string four;
  while (four.size() < 4) {
    if (position_ == text_.size()) throw Undeclared("base64 text ends early");
    const char c = text_[position_++];
    if (kIgnored.find(c) == std::string_view::npos) four += c;
  }
  const std::size_t digits = std::min<std::size_t>(four.find('='), 4);
  if (digits < 2 || four.find_first_not_of('=', digits) != std::string::npos) throw Undeclared("not base64");
  std::uint32_t bits = 0;
  for (const char c : four) {
    const std::size_t value = c == '=' ? 0 : kDigits.find(c);
    if (value == std::string_view::npos) throw Undeclared("not base64");
    bits = bits << 6 | static_cast<std::uint32_t>(value);
  }
  for (std::size_t k = 0; k + 1 < digits; ++k) decoded_ += static_cast<char>(bits >> (16 - 8 * k) & 255);
}

std::string Base64Text::take(std::uint64_t count) {
  while (decoded_.size() < count) decode_four();
  std::string taken = decoded_.substr(0, count);
  decoded_.erase(0, count);
  return taken;
}

}  // namespace driftmesh::mutants
