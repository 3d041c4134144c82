#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace driftmesh {

/// Bytes that a text holds as they are or in base64, read from front to back. In base64, padding may also stand between
/// two parts that were encoded one by one, and blanks anywhere.
class EncodedBytes {
 public:
  EncodedBytes(std::string_view text, bool is_raw) : text_(text), is_raw_(is_raw) {}

  /// How many bytes are left at most.
  [[nodiscard]] std::uint64_t room() const;
  /// Takes the next `count` bytes; false if there are fewer, or characters that do not belong there.
  [[nodiscard]] bool take(std::uint64_t count, std::string& out);
  /// The same without decoding and without a copy, of bytes as they are.
  [[nodiscard]] bool take_view(std::uint64_t count, std::string_view& out);
  [[nodiscard]] bool skip(std::uint64_t count);
  /// How many characters have been read. In base64, whole groups of four.
  [[nodiscard]] std::size_t position() const { return position_; }

 private:
  [[nodiscard]] bool decode_group();

  std::string_view text_;
  bool is_raw_;
  std::size_t position_ = 0;
  std::string pending_;  // decoded and not taken yet
};

}  // namespace driftmesh
