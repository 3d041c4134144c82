#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include "driftmesh/point.hpp"

namespace driftmesh {

/// Reads a text file in one of Triangle's formats: records are lines of fields separated by blanks, '#' starts a
/// comment, empty lines are skipped. Problems are collected, so that one run shows the user the first ten of them.
class RecordScanner {
 public:
  /// `text` must outlive the scanner. A byte order mark at its start is skipped.
  RecordScanner(std::string file, std::string_view text);

  /// Advances to the next line that has a field; false at the end of the file. A line with fields that nobody asked
  /// for, other than 0, is a problem.
  bool next_record();
  /// Advances to the next record, or throws: "the file ends where <what> is expected; <next>".
  void require_record(const std::string& what, const std::string& next);
  /// Advances to the record of element `index` of the `count` that a header announced, or throws.
  void require_element(std::int32_t index, std::int32_t count, const char* what);
  /// Throws unless the file ends after the records that its headers announce.
  void require_end();
  /// Whether the current record has another field.
  [[nodiscard]] bool has_field();
  /// Whether the current line has a problem. Its remaining fields then read as 0 without further problems.
  [[nodiscard]] bool broken() const { return broken_line_ == line_; }

  /// The next field of the record. If it is missing, not of this kind or out of range, a problem is noted that begins
  /// with `what`, and it reads as 0.
  std::int32_t integer(const char* what);
  double number(const char* what);  ///< finite
  Point point();                    ///< both coordinates in range, rounded to kCoordinateGrid

  /// A field that announces a count or a choice from 0 to `limit`; throws if it is anything else.
  std::int32_t header(const char* what, std::int32_t limit = std::numeric_limits<std::int32_t>::max());
  /// Like header(); 0 if the record has no more fields.
  std::int32_t optional_header(const char* what, std::int32_t limit);
  /// Throws unless the rest of the file can hold `count` records of `fields` fields, so that a wrong header does not
  /// cause a huge allocation.
  void require_room(std::int32_t count, const char* what, std::int32_t fields);

  /// Notes a problem on the current line; throws all problems when there are too many.
  void problem(const std::string& what, const std::string& next);
  /// Notes a problem and throws.
  [[noreturn]] void fail(const std::string& what, const std::string& next);
  /// Throws InputError with all problems, one per line, if there are any.
  void throw_problems() const;

 private:
  bool next_line();
  void note_surplus_fields();
  [[nodiscard]] bool at_end_of_record() const;
  [[nodiscard]] bool at_end_of_field() const;
  std::string_view take_field();
  template <class T>
  T parse(const char* what);
  double coordinate(const char* what);

  std::string file_;
  const char* at_;
  const char* end_;
  std::size_t line_ = 1;
  std::size_t broken_line_ = 0;
  std::size_t first_problem_ = 0;  // its line
  bool started_ = false;
  std::size_t problem_count_ = 0;
  std::string problems_;
};

}  // namespace driftmesh
