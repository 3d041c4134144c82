#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace driftmesh::mutants {

/// The files of one folder: their names, and their bytes.
using Files = std::map<std::string, std::string>;

/// Files that declare nothing: not of their format, or in contradiction with themselves. The message says why.
class Undeclared : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A place in a file that holds one value.
struct Field {
  enum class Kind { kText, kInt8, kInt32, kInt64, kFloat32, kFloat64, kBase64 };
  std::size_t begin = 0;
  std::size_t size = 0;
  Kind kind = Kind::kText;
  bool ends_record = false;
};

/// The fields of a file, noted while it is read.
using Fields = std::vector<Field>;

/// The fields of a text: what stands between blanks and the punctuation marks of YAML and XML.
[[nodiscard]] Fields text_fields(std::string_view text);

/// A number in decimal digits, with a sign; nothing for any other text.
[[nodiscard]] std::optional<std::int64_t> whole_number(std::string_view text);
/// The same with fraction and exponent; "nan" and "inf" are numbers, too.
[[nodiscard]] std::optional<double> real_number(std::string_view text);

/// Bytes as base64.
[[nodiscard]] std::string to_base64(std::string_view bytes);

/// What is encoded in a text, read from front to back. Blanks are skipped, and padding may stand within the text, where
/// one encoded part ends and another begins.
class Base64Text {
 public:
  explicit Base64Text(std::string_view text) : text_(text) {}
  /// The next bytes. Throws Undeclared if there are fewer.
  std::string take(std::uint64_t count);
  /// How much of the text has been read.
  [[nodiscard]] std::size_t position() const { return position_; }

 private:
  void decode_four();

  std::string_view text_;
  std::size_t position_ = 0;
  std::string decoded_;  // not yet taken
};

}  // namespace driftmesh::mutants
