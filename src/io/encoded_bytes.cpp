#include "io/encoded_bytes.hpp"

#include <array>

#include "io/byte_cursor.hpp"

namespace driftmesh {
namespace {

constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::uint8_t kNoDigit = 255;

constexpr std::array<std::uint8_t, 256> digit_values() {
  std::array<std::uint8_t, 256> values{};
  values.fill(kNoDigit);
  for (std::size_t i = 0; i < kDigits.size(); ++i)
    values[static_cast<unsigned char>(kDigits[i])] = static_cast<std::uint8_t>(i);
  return values;
}
constexpr auto kValues = digit_values();

}  // namespace

std::uint64_t EncodedBytes::room() const {
  const std::uint64_t characters = text_.size() - position_;
  return pending_.size() + (is_raw_ ? characters : characters / 4 * 3);
}

/// Four digits make three bytes; "xx==" and "xxx=" one and two.
bool EncodedBytes::decode_group() {
  std::uint32_t bits = 0;
  int digits = 0, padding = 0;
  while (digits + padding < 4) {
    if (position_ == text_.size()) return false;
    const char c = text_[position_++];
    if (ByteCursor::is_blank(c)) continue;
    if (c == '=' && digits >= 2) {
      ++padding;
      bits <<= 6;
      continue;
    }
    const std::uint8_t value = kValues[static_cast<unsigned char>(c)];
    if (value == kNoDigit || padding > 0) return false;
    bits = bits << 6 | value;
    ++digits;
  }
  for (int i = 0; i < 3 - padding; ++i) pending_ += static_cast<char>(bits >> (16 - 8 * i) & 0xff);
  return true;
}

bool EncodedBytes::take(std::uint64_t count, std::string& out) {
  out.clear();
  if (count > room()) return false;
  if (is_raw_) {
    std::string_view view;
    if (!take_view(count, view)) return false;
    out = view;
    return true;
  }
  out.reserve(count);
  while (true) {
    const std::size_t wanted = count - out.size();
    out.append(pending_, 0, wanted);
    pending_.erase(0, wanted);
    if (out.size() == count) return true;
    if (!decode_group()) return false;
  }
}

bool EncodedBytes::take_view(std::uint64_t count, std::string_view& out) {
  if (!is_raw_ || count > room()) return false;
  out = text_.substr(position_, count);
  position_ += count;
  return true;
}

bool EncodedBytes::skip(std::uint64_t count) {
  if (count > room()) return false;
  if (is_raw_) {
    position_ += count;
    return true;
  }
  for (std::uint64_t left = count; true;) {
    const std::uint64_t here = std::min<std::uint64_t>(left, pending_.size());
    pending_.erase(0, here);
    left -= here;
    if (left == 0) return true;
    if (!decode_group()) return false;
  }
}

}  // namespace driftmesh
