#pragma once

#include <algorithm>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "driftmesh/error.hpp"

namespace driftmesh {

/// The bytes of a file in memory, as text and as binary data, read from front to back. A length found in the file is
/// trusted only after checking that the file has that many bytes, so a damaged file causes an InputError and not a huge
/// allocation.
class ByteCursor {
 public:
  ByteCursor(const std::string& path, std::string_view bytes) : path_(path), all_(bytes), bytes_(bytes) {}

  [[nodiscard]] std::size_t remaining() const { return bytes_.size(); }
  [[nodiscard]] std::string_view rest() const { return bytes_; }

  /// Where the cursor stands: the line, if the file is all text up to there.
  [[nodiscard]] SourcePlace place() const {
    const std::string_view before = all_.substr(0, all_.size() - bytes_.size());
    const bool is_text = before.find('\0') == std::string_view::npos;
    return {path_, is_text ? 1 + static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n')) : 0};
  }

  template <class T>
  requires std::is_trivially_copyable_v<T> T take(const char* what) {
    T value;
    std::memcpy(&value, take_bytes(1, sizeof(T), what).data(), sizeof(T));
    return value;
  }

  /// The bytes of `count` items of `size` bytes each.
  std::string_view take_bytes(std::uint64_t count, std::size_t size, const char* what) {
    if (count > bytes_.size() / size)
      throw InputError(place(), std::string("ends within ") + what, "it was not written completely, or is damaged");
    const std::string_view taken = bytes_.substr(0, count * size);
    bytes_.remove_prefix(taken.size());
    return taken;
  }

  [[nodiscard]] static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

  void skip_blanks() {
    std::size_t blanks = 0;
    while (blanks < bytes_.size() && is_blank(bytes_[blanks])) ++blanks;
    bytes_.remove_prefix(blanks);
  }

  /// The rest of the current line, without its end.
  std::string_view take_line() {
    const std::size_t end = bytes_.find('\n');
    std::string_view line = bytes_.substr(0, end);
    bytes_.remove_prefix(end == std::string_view::npos ? bytes_.size() : end + 1);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return line;
  }

 private:
  const std::string& path_;
  std::string_view all_;
  std::string_view bytes_;  // what is left
};

}  // namespace driftmesh
