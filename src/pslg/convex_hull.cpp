#include "pslg/convex_hull.hpp"

#include <algorithm>
#include <numeric>

#include "geometry/predicates.hpp"

namespace driftmesh {
namespace {

/// The points of `order` that lie on the lower border of the hull, collinear ones included.
std::vector<std::int32_t> lower_border(const std::vector<Point>& points, const std::vector<std::int32_t>& order) {
  const auto at = [&](std::int32_t i) -> const Point& { return points[i]; };
  std::vector<std::int32_t> border;
  for (const std::int32_t i : order) {
    while (border.size() >= 2 && orient2d(at(border[border.size() - 2]), at(border.back()), at(i)) < 0)
      border.pop_back();
    border.push_back(i);
  }
  return border;
}

}  // namespace

std::vector<Pslg::Segment> convex_hull(const std::vector<Point>& points) {
  if (points.size() < 3) return {};
  std::vector<std::int32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::int32_t i, std::int32_t j) {
    const Point &a = points[i], &b = points[j];
    return a.x != b.x ? a.x < b.x : a.y < b.y;
  });
  std::vector<std::int32_t> ring = lower_border(points, order);
  std::reverse(order.begin(), order.end());
  const std::vector<std::int32_t> upper = lower_border(points, order);
  if (ring.size() == points.size() && upper.size() == points.size()) return {};
  ring.insert(ring.end(), upper.begin() + 1, upper.end() - 1);

  std::vector<Pslg::Segment> hull;
  for (std::size_t i = 0; i < ring.size(); ++i) hull.push_back({ring[i], ring[(i + 1) % ring.size()], 1});
  return hull;
}

}  // namespace driftmesh
