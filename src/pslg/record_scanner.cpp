#include "pslg/record_scanner.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

#include "base/from_chars.hpp"
#include "driftmesh/error.hpp"
#include "geometry/predicates.hpp"

namespace driftmesh {
namespace {

constexpr std::size_t kMaxProblems = 10;
constexpr std::size_t kMaxQuotedBytes = 24;

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

// For messages on a terminal: no control bytes, no kilobytes.
std::string quoted(std::string_view field) {
  std::string shown = "'";
  for (const char c : field.substr(0, kMaxQuotedBytes)) shown += c > ' ' && c < '\x7f' ? c : '?';
  return shown + (field.size() > kMaxQuotedBytes ? "...'" : "'");
}

}  // namespace

RecordScanner::RecordScanner(std::string file, std::string_view text)
    : file_(std::move(file)), at_(text.data()), end_(text.data() + text.size()) {
  if (text.starts_with("\xef\xbb\xbf")) at_ += 3;
}

bool RecordScanner::at_end_of_record() const {
  return at_ == end_ || *at_ == '\n' || *at_ == '#';
}

bool RecordScanner::at_end_of_field() const {
  return at_end_of_record() || is_blank(*at_);
}

bool RecordScanner::has_field() {
  while (at_ != end_ && is_blank(*at_)) ++at_;
  return !at_end_of_record();
}

bool RecordScanner::next_line() {
  const void* const newline = at_ == end_ ? nullptr : std::memchr(at_, '\n', end_ - at_);
  if (newline == nullptr) return false;
  at_ = static_cast<const char*>(newline) + 1;
  ++line_;
  return true;
}

// Zeros are what missing markers and attributes count as: nothing is lost with them, and published models have them.
void RecordScanner::note_surplus_fields() {
  while (started_ && !broken() && has_field())
    if (const std::string_view field = take_field(); field != "0")
      problem("the line has more fields than announced, from " + quoted(field) + " on",
              "remove them, or correct the number of columns in the header");
}

bool RecordScanner::next_record() {
  note_surplus_fields();
  bool more = !std::exchange(started_, true) || next_line();
  while (more && !has_field()) more = next_line();
  if (!more) at_ = end_;
  return more;
}

void RecordScanner::require_record(const std::string& what, const std::string& next) {
  if (!next_record()) fail("the file ends where " + what + " is expected", next);
}

void RecordScanner::require_end() {
  if (next_record()) fail("there are more records than announced", "correct the number in the header, or remove them");
}

std::string_view RecordScanner::take_field() {
  const char* const begin = at_;
  while (!at_end_of_field()) ++at_;
  return std::string_view(begin, at_ - begin);
}

void RecordScanner::require_element(std::int32_t index, std::int32_t count, const char* what) {
  if (next_record()) return;
  fail("the file ends after " + std::to_string(index) + " of " + std::to_string(count) + " " + what,
       "it may be truncated, or the number in the header is wrong");
}

template <class T>
T RecordScanner::parse(const char* what) {
  constexpr const char* kKind = std::is_integral_v<T> ? "a whole number" : "a number";
  if (broken()) return T{};
  if (!has_field()) {
    problem(std::string(what) + " is missing", "add it or correct the number of columns that the header announces");
    return T{};
  }
  T value{};
  const bool has_plus = *at_ == '+' && at_ + 1 != end_ && at_[1] != '-';
  const auto [stop, error] = from_chars(has_plus ? at_ + 1 : at_, end_, value);
  const std::string_view field = take_field();
  if (error == std::errc() && stop == at_) return value;
  if (error == std::errc::result_out_of_range && stop == at_)
    problem(std::string(what) + " " + quoted(field) + " is too large or too small", "use a number of moderate size");
  else
    problem(std::string(what) + " is " + quoted(field) + ", which is not " + kKind, "correct the field");
  return T{};
}

std::int32_t RecordScanner::integer(const char* what) {
  return parse<std::int32_t>(what);
}

double RecordScanner::number(const char* what) {
  const double value = parse<double>(what);
  if (std::isfinite(value)) return value;
  problem(std::string(what) + " is not finite", "replace NaN and infinity by numbers or remove the record");
  return 0;
}

double RecordScanner::coordinate(const char* what) {
  const double value = number(what);
  if (std::fabs(value) <= kMaxCoordinate) return rounded_to(value, kCoordinateGrid);
  problem(std::string(what) + " is outside the range of coordinates",
          "scale the input: magnitudes up to 1.7e72 are supported");
  return 0;
}

Point RecordScanner::point() {
  const double x = coordinate("x");
  const double y = coordinate("y");
  return {x, y};
}

std::int32_t RecordScanner::header(const char* what, std::int32_t limit) {
  const std::int32_t value = integer(what);
  if (broken()) throw_problems();
  if (value < 0 || value > limit)
    fail(std::string(what) + " is " + std::to_string(value), "expected 0 to " + std::to_string(limit));
  return value;
}

std::int32_t RecordScanner::optional_header(const char* what, std::int32_t limit) {
  return has_field() ? header(what, limit) : 0;
}

void RecordScanner::require_room(std::int32_t count, const char* what, std::int32_t fields) {
  const std::size_t bytes_left = end_ - at_;
  const std::size_t room = bytes_left / (2 * fields);  // a field is a blank and a digit
  if (std::cmp_less_equal(count, room)) return;
  fail("announces " + std::to_string(count) + " " + what + ", but the rest of the file has room for " +
           std::to_string(room) + " at most",
       "correct the number, or the file is truncated");
}

void RecordScanner::problem(const std::string& what, const std::string& next) {
  broken_line_ = line_;
  if (problems_.empty())
    first_problem_ = line_;
  else
    problems_ += '\n';
  problems_ += InputError({file_, line_}, what, next).what();
  if (++problem_count_ < kMaxProblems) return;
  problems_ += "\nand possibly more: reading stopped after " + std::to_string(kMaxProblems) + " problems";
  throw_problems();
}

void RecordScanner::throw_problems() const {
  if (!problems_.empty()) throw InputError(problems_, {file_, first_problem_});
}

void RecordScanner::fail(const std::string& what, const std::string& next) {
  problem(what, next);
  throw InputError(problems_, {file_, first_problem_});
}

}  // namespace driftmesh
