#include "report/page_block.hpp"

#include <algorithm>

#include "report/packed_text.hpp"

namespace driftmesh {

void add_block(std::string& to, const std::string& attributes, const void* bytes, std::size_t count) {
  to += "<script type=\"text/plain\" " + attributes + ">";
  to += packed_text(bytes, count);
  to += "</script>\n";
}

Corners corners_of(const std::vector<Point>& points) {
  Point low = points.front(), high = low;
  for (const Point& p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  return {low, high};
}

Point middle_of(const Corners& corners) {
  const auto& [low, high] = corners;
  return {low.x + (high.x - low.x) / 2, low.y + (high.y - low.y) / 2};
}

std::vector<float> near_the_middle(const std::vector<Point>& points, const Point& middle) {
  std::vector<float> near;
  near.reserve(2 * points.size());
  for (const Point& p : points) {
    near.push_back(static_cast<float>(p.x - middle.x));
    near.push_back(static_cast<float>(p.y - middle.y));
  }
  return near;
}

}  // namespace driftmesh
