#include "pslg/polylines.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace driftmesh {
namespace {

constexpr std::int32_t kNobody = -1;

/// Up to two segments at each point, and how many there are.
struct Star {
  std::array<std::int32_t, 2> segment{kNobody, kNobody};
  std::int32_t count = 0;
};

class LineTracer {
 public:
  explicit LineTracer(const Pslg& pslg)
      : pslg_(pslg), stars_(pslg.points.size()), traced_(pslg.segments.size(), false) {
    for (std::size_t s = 0; s < pslg.segments.size(); ++s)
      for (const std::int32_t end : {pslg.segments[s].a, pslg.segments[s].b}) {
        Star& star = stars_[end];
        if (star.count < 2) star.segment[star.count] = static_cast<std::int32_t>(s);
        ++star.count;
      }
  }

  std::vector<Polyline> lines() {
    std::vector<Polyline> lines;
    for (std::size_t s = 0; s < pslg_.segments.size(); ++s)
      if (!traced_[s]) lines.push_back(line_through(static_cast<std::int32_t>(s)));
    return lines;
  }

 private:
  [[nodiscard]] std::int32_t other_end(std::int32_t segment, std::int32_t end) const {
    const Pslg::Segment& s = pslg_.segments[segment];
    return s.a == end ? s.b : s.a;
  }

  [[nodiscard]] bool must_stay(std::int32_t point) const {
    const Star& star = stars_[point];
    if (star.count != 2) return true;
    if (pslg_.segments[star.segment[0]].marker != pslg_.segments[star.segment[1]].marker) return true;
    if (pslg_.point_markers.empty()) return false;
    return std::ranges::any_of(star.segment, [&](std::int32_t s) {
      return pslg_.point_markers[other_end(s, point)] != pslg_.point_markers[point];
    });
  }

  /// Follows the line from `point` along `segment`, and adds what comes, until a point that must stay, or `start`.
  void follow(std::int32_t point, std::int32_t segment, std::int32_t start, Polyline& line) {
    for (;;) {
      traced_[segment] = true;
      line.segments.push_back(segment);
      point = other_end(segment, point);
      if (point == start) return;
      line.points.push_back(point);
      if (must_stay(point)) return;
      const auto& at = stars_[point].segment;
      segment = at[0] == segment ? at[1] : at[0];
    }
  }

  Polyline line_through(std::int32_t segment) {
    const Pslg::Segment& s = pslg_.segments[segment];
    Polyline line;
    line.points.push_back(s.a);
    follow(s.a, segment, s.a, line);
    if (line.segments.size() == line.points.size()) {  // it has come back to s.a
      line.closed = !must_stay(s.a);
      if (!line.closed) line.points.push_back(s.a);
      return line;
    }
    if (must_stay(s.a)) return line;
    Polyline back;
    back.points.push_back(s.a);
    const auto& at = stars_[s.a].segment;
    follow(s.a, at[0] == segment ? at[1] : at[0], kNobody, back);
    std::ranges::reverse(back.points);
    std::ranges::reverse(back.segments);
    back.points.insert(back.points.end(), line.points.begin() + 1, line.points.end());
    back.segments.insert(back.segments.end(), line.segments.begin(), line.segments.end());
    return back;
  }

  const Pslg& pslg_;
  std::vector<Star> stars_;
  std::vector<bool> traced_;
};

}  // namespace

std::vector<Polyline> polylines_of(const Pslg& pslg) {
  return LineTracer(pslg).lines();
}

}  // namespace driftmesh
