#include "verify/ring_check.hpp"

#include <array>
#include <cmath>

#include "geometry/predicates.hpp"

namespace driftmesh {

RingCheck::RingCheck(const NamedMesh& mesh, const CornerTable& corners, std::vector<char>& marks,
                     const DelaunayRule& delaunay, std::size_t max_listed)
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
  if (!ring_.gather(mesh_, hub, corners_.around(hub))) {
    marks_[hub] = 1;
    return;
  }
  const bool sure =
      ring_.size() <= Ring::kUsual ? surely_delaunay<Ring::kUsual>(hub) : surely_delaunay<Ring::kMost>(hub);
  if (sure && parts_ == nullptr && in_one_subdomain()) return;
  for (std::size_t i = 1; i <= ring_.size(); ++i)
    if (is_lower(hub, ring_.neighbor(i))) check_edge(hub, i);
}

bool RingCheck::in_one_subdomain() const {
  if (mesh_.subdomains.empty()) return true;
  bool same = true;
  for (std::size_t i = 1; i < ring_.size(); ++i)
    same &= mesh_.subdomains[ring_.triangle(i)] == mesh_.subdomains[ring_.triangle(0)];
  return same;
}

void RingCheck::check_edge(std::int32_t hub, std::size_t i) {
  const EdgeCheck::Side left{ring_.triangle(i), ring_.neighbor(i + 1)};
  const EdgeCheck::Side right{ring_.triangle(i - 1), ring_.neighbor(i - 1)};
  edges_.check(hub, ring_.neighbor(i), left, right);
  if (parts_ != nullptr) parts_->join(left.triangle, right.triangle);
}

// For all edges around the hub: incircle(neighbor before, neighbor, neighbor after, hub), which is not negative if the
// edge from the hub to the neighbor is locally Delaunay. The operations and the bound on their rounding are those of
// incircle, but what edges have in common is computed once. Places behind the last neighbor, which hold the hub, give 0
// >= 0.
template <std::size_t Most>
bool RingCheck::surely_delaunay(std::int32_t hub) const {
  const Point& o = mesh_.points[hub];
  std::array<double, Most + 2> x, y, lift, cross, permanent;
  for (std::size_t i = 0; i < Most + 2; ++i) {
    const Point& p = mesh_.points[ring_.neighbor(i)];
    x[i] = p.x - o.x;
    y[i] = p.y - o.y;
  }
  for (std::size_t i = 0; i < Most + 2; ++i) lift[i] = x[i] * x[i] + y[i] * y[i];
  for (std::size_t i = 0; i < Most + 1; ++i) {
    const double l = x[i] * y[i + 1], r = x[i + 1] * y[i];
    cross[i] = l - r;
    permanent[i] = std::fabs(l) + std::fabs(r);
  }
  double least = 0;
  for (std::size_t i = 1; i < Most + 1; ++i) {
    const double l = x[i + 1] * y[i - 1], r = x[i - 1] * y[i + 1];
    const double det = lift[i - 1] * cross[i] + lift[i] * (l - r) + lift[i + 1] * cross[i - 1];
    const double bound =
        permanent[i] * lift[i - 1] + (std::fabs(l) + std::fabs(r)) * lift[i] + permanent[i - 1] * lift[i + 1];
    const double margin = det - kIncircleBound * bound;
    least = margin < least ? margin : least;
  }
  return least >= 0;
}

}  // namespace driftmesh
