#include "sizing/field_calls.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>

#include "driftmesh/error.hpp"

namespace driftmesh {
namespace {

constexpr std::string_view kDistance = "distance", kSlope = "slope";

bool is_part_of_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

class CallReader {
 public:
  explicit CallReader(const std::string& text) : text_(text) {}

  FieldCalls read() {
    while (at_ < text_.size()) {
      const std::size_t begin = at_;
      if (is_part_of_name(text_[at_]))
        read_word();
      else
        calls_.expression += text_[at_++];
      const std::string_view word = std::string_view(text_).substr(begin, at_ - begin);
      if (word == kDistance || word == kSlope) read_call(begin, word);
    }
    return std::move(calls_);
  }

 private:
  void read_word() {
    while (at_ < text_.size() && is_part_of_name(text_[at_])) calls_.expression += text_[at_++];
  }

  /// After the name at `begin`, which is left to muParser unless a parenthesis follows.
  void read_call(std::size_t begin, std::string_view word) {
    const std::size_t behind = at_;
    if (!take('(')) {
      at_ = behind;
      return;
    }
    const std::string name =
        word == kDistance ? FieldCalls::distance_name(index_of(read_markers())) : FieldCalls::slope_name(read_raster());
    calls_.expression.resize(calls_.expression.size() - word.size());
    calls_.expression += name + std::string(std::max(at_ - begin, name.size()) - name.size(), ' ');
  }

  std::string read_raster() {
    skip_space();
    const std::size_t begin = at_;
    while (at_ < text_.size() && is_part_of_name(text_[at_])) ++at_;
    std::string name = text_.substr(begin, at_ - begin);
    if (name.empty() || !take(')'))
      fail("the argument of slope is the name of a raster", "write for example slope(depth)");
    if (std::ranges::find(calls_.slopes, name) == calls_.slopes.end()) calls_.slopes.push_back(name);
    return name;
  }

  std::vector<std::int32_t> read_markers() {
    std::vector<std::int32_t> markers;
    if (take(')')) return markers;
    do markers.push_back(read_marker());
    while (take(','));
    if (!take(')')) fail_in_distance();
    std::ranges::sort(markers);
    markers.erase(std::unique(markers.begin(), markers.end()), markers.end());
    return markers;
  }

  std::int32_t read_marker() {
    skip_space();
    std::int32_t marker = 0;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), marker);
    if (error != std::errc{}) fail_in_distance();
    at_ = end - text_.data();
    return marker;
  }

  std::size_t index_of(std::vector<std::int32_t> markers) {
    const auto found = std::ranges::find(calls_.markers, markers);
    const std::size_t k = found - calls_.markers.begin();
    if (found == calls_.markers.end()) calls_.markers.push_back(std::move(markers));
    return k;
  }

  void skip_space() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
  }
  bool take(char c) {
    skip_space();
    if (at_ == text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  [[noreturn]] void fail(const char* what, const char* next) const {
    throw InputError({"size expression \"" + text_ + '"'},
                     "column " + std::to_string(std::min(at_, text_.size()) + 1) + ": " + what, next);
  }
  [[noreturn]] void fail_in_distance() const {
    fail("the arguments of distance are markers of segments, whole numbers with commas between them",
         "write distance(1, 2), or distance() for all segments");
  }

  const std::string& text_;
  std::size_t at_ = 0;
  FieldCalls calls_;
};

}  // namespace

std::string FieldCalls::distance_name(std::size_t k) {
  return std::string(kDistance) + '_' + std::to_string(k);
}

std::string FieldCalls::slope_name(const std::string& raster) {
  return std::string(kSlope) + '_' + raster;
}

bool FieldCalls::reserves(std::string_view name) {
  for (const std::string_view word : {kDistance, kSlope})
    if (name == word || name.starts_with(std::string(word) + '_')) return true;
  return false;
}

FieldCalls take_field_calls(const std::string& expression) {
  return CallReader(expression).read();
}

}  // namespace driftmesh
