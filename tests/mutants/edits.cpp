#include "mutants/edits.hpp"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <limits>
#include <random>
#include <utility>

#include "mutants/declared_msh.hpp"
#include "mutants/declared_vtu.hpp"
#include "mutants/xml_tree.hpp"

namespace driftmesh::mutants {
namespace {

/// Fields of binary formats as far as they can be read.
Fields fields_of(const std::string& name, const std::string& bytes) {
  Fields fields;
  try {
    if (name.ends_with(".vtu")) (void)declared_vtu(bytes, fields);
    if (name.ends_with(".pvtu")) (void)xml_tree(bytes, fields);
    if (name.ends_with(".msh")) (void)declared_msh(bytes, fields);
  } catch (const Undeclared&) {
    // The fields before the fault will do.
  }
  return fields.empty() ? text_fields(bytes) : fields;
}

/// The lines of a text, each with its end.
std::vector<std::string> lines_of(const std::string& bytes) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < bytes.size(); begin += lines.back().size())
    lines.push_back(bytes.substr(begin, std::min(bytes.find('\n', begin), bytes.size() - 1) + 1 - begin));
  return lines;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string bytes;
  for (const std::string& line : lines) bytes += line;
  return bytes;
}

/// One more or less, around the ends of the type.
std::string next_to(std::int64_t number, bool is_more) {
  return std::to_string(
      static_cast<std::int64_t>(static_cast<std::uint64_t>(number) + (is_more ? 1 : ~std::uint64_t{0})));
}

class Editor {
 public:
  Editor(const std::vector<Sample>& corpus, std::uint64_t seed)
      : corpus_(corpus), random_(seed * 0x9e3779b97f4a7c15U + 1), mutant_{sample_of(corpus, seed).files, {}} {}

  Mutant run() {
    for (std::uint64_t left = 1 + below(3); left > 0; --left) edit_one();
    return std::move(mutant_);
  }

 private:
  std::uint64_t below(std::uint64_t limit) { return random_() % limit; }
  template <class Items>
  auto& one_of(Items& items) {
    return *std::next(std::begin(items), static_cast<std::ptrdiff_t>(below(std::size(items))));
  }

  void edit_one() {
    if (mutant_.files.empty()) return;
    auto& [name, bytes] = one_of(mutant_.files);
    const std::uint64_t choice = below(100);
    if (bytes.empty() || choice < 2) return edit_file(name, bytes);
    std::string words;
    if (choice < 50)
      words = edit_field(name, bytes);
    else if (choice < 58)
      words = swap_fields(name, bytes);
    else if (choice < 72)
      words = edit_line(bytes);
    else if (choice < 80)
      words = edit_line_and_count(name, bytes);
    else if (choice < 90)
      words = edit_bytes(bytes);
    else
      words = edit_block(bytes);
    mutant_.edits.push_back(name + ": " + words);
  }

  void edit_file(const std::string& name, std::string& bytes) {
    const std::uint64_t choice = below(6);
    const Sample& other = one_of(corpus_);
    const auto& [other_name, other_bytes] = one_of(choice == 2 ? mutant_.files : other.files);
    mutant_.edits.push_back(name + (choice == 0 ? ": removed"
                                    : choice == 1
                                        ? ": emptied"
                                        : ": that of " + (choice == 2 ? other_name : other.name + "/" + other_name)));
    if (choice == 0)
      mutant_.files.erase(std::string(name));
    else
      bytes = choice == 1 ? "" : std::string(other_bytes);
  }

  std::string edit_field(const std::string& name, std::string& bytes) {
    const Fields fields = fields_of(name, bytes);
    if (fields.empty()) return edit_bytes(bytes);
    const Field field = one_of(fields), other = one_of(fields);
    const std::string before = bytes.substr(field.begin, field.size);
    std::string after;
    if (field.kind == other.kind && field.kind != Field::Kind::kBase64 && below(8) == 0)
      after = bytes.substr(other.begin, other.size);
    else if (field.kind == Field::Kind::kText)
      after = other_text(before);
    else if (field.kind == Field::Kind::kBase64)
      after = other_base64(before);
    else
      after = other_word(field.kind, before);
    bytes.replace(field.begin, field.size, after);
    if (field.kind != Field::Kind::kText)
      return "a number of " + std::to_string(field.size) + " bytes at " + std::to_string(field.begin);
    return "'" + before + "' becomes '" + after + "'";
  }

  std::string other_text(const std::string& text) {
    static const std::string kTexts[] = {"0",
                                         "1",
                                         "-1",
                                         "2",
                                         "3",
                                         "4",
                                         "6",
                                         "2147483647",
                                         "2147483648",
                                         "-2147483648",
                                         "-2147483649",
                                         "4294967295",
                                         "4294967296",
                                         "9223372036854775807",
                                         "18446744073709551615",
                                         "1e9",
                                         "1e300",
                                         "1e-300",
                                         "1e400",
                                         "nan",
                                         "inf",
                                         "-0",
                                         "0.5",
                                         "",
                                         "x",
                                         "true",
                                         "-",
                                         "1 2",
                                         "0 0",
                                         "#"};
    const std::optional<std::int64_t> whole = whole_number(text);
    if (whole && below(2) == 0) return next_to(*whole, below(2) == 0);
    const std::optional<double> real = real_number(text);
    if (real && below(8) == 0) return std::to_string(*real * (below(2) == 0 ? -1 : 1 + 1e-3));
    if (!text.empty() && below(6) == 0) return text.substr(0, below(text.size())) + text.substr(text.size() / 2);
    return one_of(kTexts);
  }

  template <class T>
  std::string other_number(const std::string& word) {
    T value;
    std::memcpy(&value, word.data(), sizeof(T));
    using Limits = std::numeric_limits<T>;
    const T others[] = {T(0),
                        T(1),
                        T(2),
                        T(3),
                        T(5),
                        T(-1),
                        Limits::max(),
                        Limits::lowest(),
                        Limits::quiet_NaN(),
                        Limits::infinity(),
                        T(value / T(2)),
                        T(100)};
    if (below(2) == 0)
      value = below(2) == 0 ? next_up(value) : next_down(value);
    else
      value = one_of(others);
    return {reinterpret_cast<const char*>(&value), sizeof(T)};
  }
  template <class T>
  static T next_up(T value) {
    return value < std::numeric_limits<T>::max() ? static_cast<T>(value + 1) : value;
  }
  template <class T>
  static T next_down(T value) {
    return value > std::numeric_limits<T>::lowest() ? static_cast<T>(value - 1) : value;
  }

  std::string other_word(Field::Kind kind, const std::string& word) {
    if (kind == Field::Kind::kInt32) return other_number<std::int32_t>(word);
    if (kind == Field::Kind::kInt64) return other_number<std::int64_t>(word);
    if (kind == Field::Kind::kFloat32) return other_number<float>(word);
    if (kind == Field::Kind::kFloat64) return other_number<double>(word);
    return other_number<std::int8_t>(word.substr(0, 1)) + word.substr(1);
  }

  /// Another word in what is encoded: the lengths at its start, or a number.
  std::string other_base64(const std::string& text) {
    std::string decoded;
    try {
      Base64Text encoded(text);
      while (true) decoded += encoded.take(1);
    } catch (const Undeclared&) {
      // That was all.
    }
    const std::size_t size = below(2) == 0 ? 4 : 8;
    if (decoded.size() < size) return other_text(text);
    const std::size_t word =
        below(3) == 0 ? below(std::min<std::size_t>(4, decoded.size() / size)) : below(decoded.size() / size);
    const std::string old = decoded.substr(word * size, size);
    const Field::Kind kind = size == 4       ? Field::Kind::kInt32
                             : below(2) == 0 ? Field::Kind::kInt64
                                             : Field::Kind::kFloat64;
    return to_base64(decoded.replace(word * size, size, other_word(kind, old)));
  }

  std::string swap_fields(const std::string& name, std::string& bytes) {
    const Fields fields = fields_of(name, bytes);
    if (fields.size() < 2) return edit_bytes(bytes);
    const std::size_t i = below(fields.size());
    const std::size_t j = below(2) == 0 ? (i + 1) % fields.size() : below(fields.size());
    const Field &a = fields[std::min(i, j)], &b = fields[std::max(i, j)];
    if (a.begin + a.size > b.begin) return edit_bytes(bytes);
    const std::string first = bytes.substr(a.begin, a.size), second = bytes.substr(b.begin, b.size);
    bytes.replace(b.begin, b.size, first).replace(a.begin, a.size, second);
    return "fields " + std::to_string(std::min(i, j)) + " and " + std::to_string(std::max(i, j)) + " swapped";
  }

  std::string edit_line(std::string& bytes) {
    std::vector<std::string> lines = lines_of(bytes);
    const std::size_t i = below(lines.size()), j = below(lines.size());
    const auto place = lines.begin() + static_cast<std::ptrdiff_t>(i);
    const std::string number = "line " + std::to_string(i + 1), other = "line " + std::to_string(j + 1);
    std::string words;
    switch (below(4)) {
      case 0:
        lines.erase(place);
        words = number + " removed";
        break;
      case 1:
        lines.insert(place, std::string(lines[j]));
        words = other + " also before " + number;
        break;
      case 2:
        lines.resize(i);
        words = "cut off before " + number;
        break;
      default:
        std::swap(lines[i], lines[j]);
        words = number + " and " + other + " swapped";
    }
    bytes = joined(lines);
    return words;
  }

  /// A line more or less, and one number before it that is one higher or lower: perhaps their count.
  std::string edit_line_and_count(const std::string& name, std::string& bytes) {
    std::vector<std::string> lines = lines_of(bytes);
    const std::size_t i = below(lines.size());
    const auto place = lines.begin() + static_cast<std::ptrdiff_t>(i);
    std::vector<Field> numbers, first_on_line;
    const std::string before = joined({lines.begin(), place});
    for (const Field& field : fields_of(name, before)) {
      if (field.kind != Field::Kind::kText || !whole_number(before.substr(field.begin, field.size))) continue;
      numbers.push_back(field);
      if (field.begin == 0 || before[field.begin - 1] == '\n') first_on_line.push_back(field);
    }
    if (numbers.empty()) return edit_line(bytes);
    const Field field = !first_on_line.empty() && below(2) == 0 ? one_of(first_on_line) : one_of(numbers);
    const bool is_removed = below(2) == 0;
    const std::string number = before.substr(field.begin, field.size);
    const std::string count = next_to(*whole_number(number), !is_removed);
    if (is_removed)
      lines.erase(place);
    else
      lines.insert(place, std::string(lines[i]));
    bytes = joined(lines).replace(field.begin, field.size, count);
    return "line " + std::to_string(i + 1) + (is_removed ? " removed" : " doubled") + ", and a '" + number +
           "' before it becomes '" + count + "'";
  }

  std::string edit_bytes(std::string& bytes) {
    const std::size_t at = below(bytes.size());
    switch (below(3)) {
      case 0:
        bytes.erase(at, 1);
        return "byte " + std::to_string(at) + " removed";
      case 1:
        bytes.insert(at, 1, static_cast<char>(below(2) == 0 ? below(256) : 32 + below(95)));
        return "a byte added at " + std::to_string(at);
      default:
        for (std::uint64_t left = 1 + below(4); left > 0; --left) {
          char& byte = bytes[below(2) == 0 ? at : below(bytes.size())];
          byte = static_cast<char>(byte ^ (below(2) == 0 ? 1 << below(8) : static_cast<int>(below(256))));
        }
        return "some bytes changed";
    }
  }

  std::string edit_block(std::string& bytes) {
    const std::size_t at = below(bytes.size());
    const std::size_t size = 1 + below(std::min<std::size_t>(bytes.size() - at, below(2) == 0 ? 16 : 4096));
    const std::string block = bytes.substr(at, size);
    const std::string words = std::to_string(size) + " bytes at " + std::to_string(at);
    switch (below(4)) {
      case 0:
        bytes.erase(at, size);
        return words + " removed";
      case 1:
        bytes.insert(at, block);
        return words + " doubled";
      case 2:
        bytes.replace(at, size, size, '\0');
        return words + " set to 0";
      default:
        bytes.resize(at);
        return "cut off at " + std::to_string(at);
    }
  }

  const std::vector<Sample>& corpus_;
  std::mt19937_64 random_;
  Mutant mutant_;
};

}  // namespace

Mutant mutant_of(const std::vector<Sample>& corpus, std::uint64_t seed) {
  return Editor(corpus, seed).run();
}

}  // namespace driftmesh::mutants
