#include "verify/ring_check.hpp"

#include <cmath>

#include "geometry/predicates.hpp"

namespace driftmesh {

RingCheck::RingCheck(const NamedMesh& mesh, const CornerTable& corners, std::vector<char>& marks, bool delaunay,
                     std::size_t max_listed)
    : names_(mesh),
      mesh_(mesh.mesh()),
      corners_(corners),
      marks_(marks),
      edges_(mesh, delaunay, max_listed),
      ascending_(mesh.ascending()) {}

void RingCheck::check(std::size_t begin, std::size_t end, DisjointSets<std::int32_t>* parts) {
  parts_ = parts;
  for (std::size_t hub = begin; hub < end; ++hub)
    if (marks_[hub] == 0) check_hub(static_cast<std::int32_t>(hub));
}

void RingCheck::check_hub(std::int32_t hub) {
  if (!ring_.gather(mesh_, corners_.around(hub))) {
    marks_[hub] = 1;
    return;
  }
  measure_ring(hub);
  const std::size_t n = ring_.size();
  for (std::size_t i = 0; i < n; ++i) {
    const std::int32_t v = ring_.neighbor(i);
    if (!is_lower(hub, v)) continue;
    const std::size_t before = i == 0 ? n - 1 : i - 1, after = i + 1 == n ? 0 : i + 1;
    const EdgeCheck::Side left{ring_.triangle(i), ring_.neighbor(after)};
    const EdgeCheck::Side right{ring_.triangle(before), ring_.neighbor(before)};
    if (surely_delaunay(before, i, after))
      edges_.count(left, right);
    else
      edges_.check(hub, v, left, right);
    if (parts_ != nullptr) parts_->join(left.triangle, right.triangle);
  }
}

void RingCheck::measure_ring(std::int32_t hub) {
  const Point& o = mesh_.points[hub];
  const std::size_t n = ring_.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Point& p = mesh_.points[ring_.neighbor(i)];
    x_[i] = p.x - o.x;
    y_[i] = p.y - o.y;
    lift_[i] = x_[i] * x_[i] + y_[i] * y_[i];
  }
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t after = i + 1 == n ? 0 : i + 1;
    const double l = x_[i] * y_[after], r = x_[after] * y_[i];
    cross_[i] = l - r;
    permanent_[i] = std::fabs(l) + std::fabs(r);
  }
}

// incircle(before, i, after, hub), which is not negative if the edge from the hub to neighbor i is locally Delaunay: in
// the same order and with the same bound on rounding, but with what edges around a hub have in common computed once.
bool RingCheck::surely_delaunay(std::size_t before, std::size_t i, std::size_t after) const {
  const double l = x_[after] * y_[before], r = x_[before] * y_[after];
  const double det = lift_[before] * cross_[i] + lift_[i] * (l - r) + lift_[after] * cross_[before];
  const double permanent =
      permanent_[i] * lift_[before] + (std::fabs(l) + std::fabs(r)) * lift_[i] + permanent_[before] * lift_[after];
  return det >= kIncircleBound * permanent;
}

}  // namespace driftmesh
