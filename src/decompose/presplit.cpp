#include "decompose/presplit.hpp"

#include <algorithm>

#include "decompose/work.hpp"
#include "geometry/midpoint.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/size_bound.hpp"

namespace driftmesh {
namespace {

struct Spacing {
  double area_bound;
  const SizeBounds& sizes;

  /// The largest squared length of a subsegment from a to b with midpoint m.
  [[nodiscard]] double most(const Point& a, const Point& m, const Point& b) const {
    double bound = area_bound;
    if (sizes.by_place())
      for (const Point& p : {a, m, b}) bound = std::min(bound, twice_area_of_edge(sizes.length_at(p)) / 2);
    if (const TimeStep* step = sizes.step()) bound = std::max(bound, twice_area_of_edge(step->floor_between(a, b)) / 2);
    return kPresplitSpacing * kPresplitSpacing * bound;
  }
};

/// A size field without a lower limit must not lead to points with equal coordinates.
constexpr int kDeepestPath = 40;

void cut(const Spacing& spacing, const Point& a, const Point& b, dyadic::Path path, std::vector<dyadic::Path>& paths) {
  const Point m = midpoint(a, b);
  if (squared_distance(a, b) <= spacing.most(a, m, b) || dyadic::depth(path) >= kDeepestPath || m == a || m == b)
    return;
  paths.push_back(path);
  cut(spacing, a, m, dyadic::first_half(path), paths);
  cut(spacing, m, b, dyadic::second_half(path), paths);
}

}  // namespace

std::vector<dyadic::Path> presplit_paths(const Decomposition& d, GlobalRootId root, const QualityBounds& bounds) {
  std::vector<dyadic::Path> paths;
  const Decomposition::Root& r = d.roots[root];
  if (!r.is_interface()) return paths;
  const SizeBounds sizes = bounds;
  if (!sizes.any()) return paths;
  const Spacing spacing{std::min(sizes.twice_area(r.left_region), sizes.twice_area(r.right_region)) / 2, sizes};
  cut(spacing, d.points[r.a], d.points[r.b], dyadic::kWhole, paths);
  return paths;
}

}  // namespace driftmesh
