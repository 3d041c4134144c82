#include "geojson/interior_point.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace driftmesh {
namespace {

constexpr std::size_t kLines = 8;

/// Between two neighboring values, far apart.
struct Gap {
  double middle = 0, width = 0;
};

/// Heights between the corners of the ring, the widest gaps first, at most kLines.
std::vector<Gap> heights(const PolygonRing& ring) {
  std::vector<double> ys;
  for (const Point p : ring) ys.push_back(p.y);
  std::ranges::sort(ys);
  std::vector<Gap> gaps;
  for (std::size_t i = 1; i < ys.size(); ++i) gaps.push_back({ys[i - 1] + (ys[i] - ys[i - 1]) / 2, ys[i] - ys[i - 1]});
  const std::size_t kept = std::min(kLines, gaps.size());
  std::ranges::partial_sort(gaps, gaps.begin() + static_cast<std::ptrdiff_t>(kept), std::ranges::greater(),
                            &Gap::width);
  gaps.resize(kept);
  return gaps;
}

/// The widest part of the line at this height that an odd number of rings encloses.
Gap widest_inside(std::span<const PolygonRing* const> rings, double y) {
  std::vector<double> crossings;
  for_each_edge(rings, [&](Point a, Point b) {
    if (spans_height(a, b, y)) crossings.push_back(a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)));
  });
  std::ranges::sort(crossings);
  Gap widest;
  for (std::size_t i = 1; i < crossings.size(); i += 2)
    if (const double width = crossings[i] - crossings[i - 1]; width > widest.width)
      widest = {crossings[i - 1] + width / 2, width};
  return widest;
}

}  // namespace

std::optional<Point> interior_point(std::span<const PolygonRing* const> rings) {
  std::optional<Point> best;
  double room = 0;
  for (const Gap& height : heights(*rings.front())) {
    if (height.width <= room) break;
    const Gap across = widest_inside(rings, height.middle);
    const Point p{across.middle, height.middle};
    const double here = std::min(across.width, height.width);
    if (here > room && is_inside(rings, p) && is_inside(rings.first(1), p)) best = p, room = here;
  }
  return best;
}

}  // namespace driftmesh
