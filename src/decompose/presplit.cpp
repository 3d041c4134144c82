#include "decompose/presplit.hpp"

#include <algorithm>

#include "decompose/work.hpp"
#include "geometry/midpoint.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh {
namespace {

struct Spacing {
  double area_bound;
  const SizeField* size;

  /// The largest squared length of a subsegment from a to b with midpoint m.
  [[nodiscard]] double most(const Point& a, const Point& m, const Point& b) const {
    double bound = area_bound;
    if (size != nullptr)
      for (const Point& p : {a, m, b}) bound = std::min(bound, twice_area_of_edge(size->edge_length(p)) / 2);
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

bool bounds_size(const QualityBounds& bounds) {
  return bounds.max_area > 0 || bounds.size != nullptr ||
         std::any_of(bounds.region_max_area.begin(), bounds.region_max_area.end(),
                     [](double area) { return area > 0; });
}

std::vector<dyadic::Path> presplit_paths(const Decomposition& d, GlobalRootId root, const QualityBounds& bounds) {
  std::vector<dyadic::Path> paths;
  const Decomposition::Root& r = d.roots[root];
  if (!r.is_interface() || !bounds_size(bounds)) return paths;
  const Spacing spacing{std::min(area_bound(bounds, r.left_region), area_bound(bounds, r.right_region)), bounds.size};
  cut(spacing, d.points[r.a], d.points[r.b], dyadic::kWhole, paths);
  return paths;
}

}  // namespace driftmesh
