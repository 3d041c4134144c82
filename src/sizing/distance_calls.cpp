#include "sizing/distance_calls.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <string_view>

#include "driftmesh/error.hpp"

namespace driftmesh {
namespace {

constexpr std::string_view kName = "distance";

bool is_part_of_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

class CallReader {
 public:
  explicit CallReader(const std::string& text) : text_(text) {}

  DistanceCalls read() {
    while (at_ < text_.size()) {
      const std::size_t begin = at_;
      if (is_part_of_name(text_[at_]))
        read_word();
      else
        calls_.expression += text_[at_++];
      if (std::string_view(text_).substr(begin, at_ - begin) == kName) read_call(begin);
    }
    return std::move(calls_);
  }

 private:
  void read_word() {
    while (at_ < text_.size() && is_part_of_name(text_[at_])) calls_.expression += text_[at_++];
  }

  /// After the name at `begin`, which is left to muParser unless a parenthesis follows.
  void read_call(std::size_t begin) {
    const std::size_t behind = at_;
    if (!take('(')) {
      at_ = behind;
      return;
    }
    const std::size_t k = index_of(read_markers());
    calls_.expression.resize(calls_.expression.size() - kName.size());
    const std::string name = DistanceCalls::name_of(k);
    calls_.expression += name + std::string(std::max(at_ - begin, name.size()) - name.size(), ' ');
  }

  std::vector<std::int32_t> read_markers() {
    std::vector<std::int32_t> markers;
    if (take(')')) return markers;
    do markers.push_back(read_marker());
    while (take(','));
    if (!take(')')) fail();
    std::ranges::sort(markers);
    markers.erase(std::unique(markers.begin(), markers.end()), markers.end());
    return markers;
  }

  std::int32_t read_marker() {
    skip_space();
    std::int32_t marker = 0;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), marker);
    if (error != std::errc{}) fail();
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

  [[noreturn]] void fail() const {
    throw InputError({"size expression \"" + text_ + '"'},
                     "column " + std::to_string(std::min(at_, text_.size()) + 1) +
                         ": the arguments of distance are markers of segments, whole numbers with commas between them",
                     "write distance(1, 2), or distance() for all segments");
  }

  const std::string& text_;
  std::size_t at_ = 0;
  DistanceCalls calls_;
};

}  // namespace

std::string DistanceCalls::name_of(std::size_t k) {
  return std::string(kName) + '_' + std::to_string(k);
}

DistanceCalls take_distance_calls(const std::string& expression) {
  return CallReader(expression).read();
}

}  // namespace driftmesh
