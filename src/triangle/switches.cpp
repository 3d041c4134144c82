#include "triangle/switches.hpp"

#include <charconv>
#include <cstddef>
#include <optional>
#include <string>

#include "base/from_chars.hpp"
#include "driftmesh/defaults.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh::triangle {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text) {}

  Switches read() {
    while (at_ < text_.size()) take(text_[at_++]);
    if (boundary_ > 0)
      switches_.rules.split = boundary_ > 1 ? InsertionRules::Split::kNowhere : InsertionRules::Split::kInside;
    if (!switches_.pslg || switches_.refine)
      switches_.region_attributes = false;  // those of an old mesh stay as they are
    if (switches_.refine && switches_.no_iteration)
      refuse('I', "would overwrite the mesh that r refines", "remove one of them");
    return switches_;
  }

 private:
  void take(char letter) {
    Switches& s = switches_;
    switch (letter) {
      case '-':
      case ' ':
      case '\t':
      case 'i':
      case 'F':
      case 'l':
      case 'X':
        return;
      case 'p':
        s.pslg = true;
        return;
      case 'r':
        s.refine = true;
        return;
      case 'q':
        return take_angle();
      case 'a':
        return take_area();
      case 'u':
        s.unsuitable = s.quality = true;
        return;
      case 'D':
      case 's':
        s.rules.conforming = s.quality = true;
        return;
      case 'Y':
        ++boundary_;
        return;
      case 'S':
        return take_steiner();
      case 'A':
        s.region_attributes = true;
        return;
      case 'c':
        s.hull = true;
        return;
      case 'j':
        s.jettison = true;
        return;
      case 'e':
        s.edges = true;
        return;
      case 'v':
        s.voronoi = true;
        return;
      case 'n':
        s.neighbors = true;
        return;
      case 'o':
        return take_order();
      case 'C':
        s.check = true;
        return;
      case 'O':
        s.no_holes = true;
        return;
      case 'B':
        s.no_markers = true;
        return;
      case 'P':
        s.no_segments = true;
        return;
      case 'N':
        s.no_points = true;
        return;
      case 'E':
        s.no_triangles = true;
        return;
      case 'I':
        s.no_iteration = true;
        return;
      case 'g':
        s.geomview = true;
        return;
      case 'z':
        s.from_zero = true;
        return;
      case 'Q':
        s.quiet = true;
        return;
      case 'V':
        s.verbose = true;
        return;
      case 'h':
        s.help = true;
        return;
      case 'w':
      case 'W':
        refuse(letter, "asks for weighted triangulations, which driftmesh does not make", "remove it");
      default:
        refuse(letter, "is none of Triangle's", "driftmesh triangle -h lists them");
    }
  }

  void take_angle() {
    switches_.quality = true;
    switches_.min_angle = number().value_or(defaults::kMinAngle);
    if (switches_.min_angle > kMaxAngle)
      refuse('q',
             "asks for angles of at least " + text_of(switches_.min_angle) + " degrees, but " + text_of(kMaxAngle) +
                 " is the most that driftmesh tries",
             "ask for less");
  }

  void take_area() {
    switches_.quality = true;
    const std::optional<double> area = number();
    if (!area) {
      switches_.given_areas = true;
    } else {
      if (*area <= 0) refuse('a', "has the area 0", "areas must be positive");
      switches_.max_area = *area;
    }
  }

  void take_order() {
    const double order = number().value_or(0);
    if (order != 1 && order != 2) refuse('o', "must be o2 (or o1, which changes nothing)", "correct it");
    switches_.second_order = order == 2;
  }

  void take_steiner() {
    const double most = number().value_or(0);
    if (most != static_cast<double>(static_cast<std::int64_t>(most)))
      refuse('S', "must be a whole number", "correct it");
    switches_.rules.most_points = static_cast<std::int64_t>(most);
  }

  /// The number at this place, if there is one. An 'e' is a switch, unless a sign and a digit follow.
  std::optional<double> number() {
    const std::size_t begin = at_;
    while (has(is_digit) || peek() == '.') ++at_;
    if (at_ == begin) return std::nullopt;
    if (peek() == 'e' && (peek(1) == '-' || peek(1) == '+') && is_digit(peek(2)))
      for (at_ += 2; has(is_digit);) ++at_;
    double value = 0;
    const char* const end = text_.data() + at_;
    const auto read = from_chars(text_.data() + begin, end, value);
    if (read.ec != std::errc() || read.ptr != end)
      refuse(text_[begin - 1], "has the number '" + std::string(text_.substr(begin, at_ - begin)) + "'", "correct it");
    return value;
  }

  [[nodiscard]] char peek(std::size_t ahead = 0) const {
    return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0';
  }
  template <class Kind>
  [[nodiscard]] bool has(const Kind& kind) const {
    return kind(peek());
  }

  static std::string text_of(double value) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
  }

  [[noreturn]] void refuse(char letter, const std::string& why, const std::string& next) const {
    throw Error("switch " + std::string(1, letter) + " in '" + std::string(text_) + "' " + why + "; " + next);
  }

  std::string_view text_;
  std::size_t at_ = 0;
  Switches switches_;
  int boundary_ = 0;  // times that Y was given
};

}  // namespace

Switches parse_switches(std::string_view text) {
  return Reader(text).read();
}

}  // namespace driftmesh::triangle
