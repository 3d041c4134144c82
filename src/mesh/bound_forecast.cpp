#include "mesh/bound_forecast.hpp"

#include <algorithm>
#include <array>

#include "geometry/midpoint.hpp"

namespace driftmesh {
namespace {

/// The mean area of triangles relative to the bound, measured for area-bounded refinement.
constexpr double kMeanArea = 0.645;

constexpr double kNotAsked = 0;  // no length

/// What is asked for in a triangle. Without a time step, the bound by region is kept apart from lengths.
class Asked {
 public:
  Asked(const SizeBounds& sizes, double twice_area_bound) : sizes_(sizes), twice_area_bound_(twice_area_bound) {}

  [[nodiscard]] double length_at(const Point& p) const {
    const double length = sizes_.length_at(p);
    if (sizes_.step() == nullptr) return length;
    return std::max(std::min(length, edge_of_twice_area(twice_area_bound_)), sizes_.step()->floor_at(p));
  }
  /// Triangles per area, where this length is asked for.
  [[nodiscard]] double density(double length) const {
    const double twice = twice_area_of_edge(length);
    return 1 / (sizes_.step() == nullptr ? std::min(twice, twice_area_bound_) : twice);
  }
  [[nodiscard]] bool falls_below(const CornerPoints& corners, double length) const {
    return sizes_.falls_below(corners, length) && (sizes_.step() == nullptr || sizes_.step()->floor(corners) < length);
  }

 private:
  const SizeBounds& sizes_;
  double twice_area_bound_;
};

/// The same in a piece that is no longer bisected although lengths fall to next to nothing at a corner: there they are
/// no more than a few triangles for each power of two, whereas that corner alone would ask for any number.
double integrate_beside_spike(const Asked& asked, double twice, const std::array<double, 3>& at_corners) {
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) sum += asked.density((at_corners[k] + at_corners[(k + 1) % 3]) / 2);
  return twice / kMeanArea * sum / 3;
}

/// How many triangles lengths ask for in a triangle, with their values at the corners: the integral of one over the
/// mean area, by bisection of the longest edge until lengths vary little or the pieces are about as small as the
/// triangles asked for. Where lengths fall between the points that were looked at, so steeply that the mesh cannot
/// follow, each piece counts at least like a triangle.
double integrate_size(const Asked& asked, const CornerPoints& corners, const std::array<double, 3>& at_corners,
                      int depth = 0, bool steep = false) {
  constexpr int kDeepest = 16, kDeepestSteep = 28;
  constexpr double kSmooth = 1.6, kSpike = 100;
  const auto [least_corner, most_corner] = std::minmax({at_corners[0], at_corners[1], at_corners[2]});
  const double twice = 2 * signed_area(corners[0], corners[1], corners[2]);
  const auto is_small = [&](double least) { return depth >= kDeepest || twice < 4 * twice_area_of_edge(least); };
  if (most_corner <= kSmooth * least_corner || is_small(least_corner)) {
    const double in_middle = asked.length_at(centroid(corners));
    const double least = std::min(least_corner, in_middle), most = std::max(most_corner, in_middle);
    if (depth >= kDeepest && most > kSpike * least) return integrate_beside_spike(asked, twice, at_corners);
    if (most <= kSmooth * least || is_small(least)) {
      const double sum = asked.density(at_corners[0]) + asked.density(at_corners[1]) + asked.density(at_corners[2]);
      const double count = twice / kMeanArea * (sum + 9 * asked.density(in_middle)) / 12;
      const double edge = std::min(least, edge_of_twice_area(twice));
      if (depth >= kDeepestSteep || !asked.falls_below(corners, edge))
        return steep ? std::max(count, 1 / kMeanArea) : count;
      steep = true;
    }
  }
  std::size_t longest = 0;  // from this corner to the next
  std::array<double, 3> squared;
  for (std::size_t k = 0; k < 3; ++k) {
    squared[k] = squared_distance(corners[k], corners[(k + 1) % 3]);
    if (squared[k] > squared[longest]) longest = k;
  }
  const std::size_t other = (longest + 1) % 3;
  const Point middle = midpoint(corners[longest], corners[other]);
  const double at_middle = asked.length_at(middle);
  const auto in = [&](std::size_t replaced) {  // the half without this end of the edge
    CornerPoints part = corners;
    std::array<double, 3> at = at_corners;
    part[replaced] = middle;
    at[replaced] = at_middle;
    return integrate_size(asked, part, at, depth + 1, steep);
  };
  return in(longest) + in(other);
}

}  // namespace

double area_of(const Triangulation& mesh) {
  double area = 0;
  for (const TriangleId t : ids_of(mesh.triangles))
    if (mesh.triangles[t].alive()) area += signed_area(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2));
  return area;
}

BoundForecast::BoundForecast(const Triangulation& mesh, const SizeBounds& sizes)
    : mesh_(mesh), areas_(mesh, sizes, kMarginOfRefinement) {
  if (!areas_.by_place()) return;
  at_vertices_.resize(mesh.points.size(), kNotAsked);
  for (const TriangleId t : ids_of(mesh.triangles)) {
    if (!mesh.triangles[t].alive()) continue;
    for (const VertexId v : mesh.triangles[t].vertex)
      if (at_vertices_[v] == kNotAsked) at_vertices_[v] = sizes.length_at(mesh.points[v]);
  }
}

double BoundForecast::in(TriangleId t, double twice_area) const {
  const bool stepped = areas_.sizes().step() != nullptr && areas_.sizes().any();
  if (!areas_.by_place() && !stepped) return twice_area / (kMeanArea * areas_.constant(t));
  const auto& v = mesh_.triangles[t].vertex;
  const Asked asked(areas_.sizes(), areas_.constant(t));
  const auto at = [&](int i) { return stepped ? asked.length_at(mesh_.corner(t, i)) : at_vertices_[v[i]]; };
  return integrate_size(asked, {mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2)}, {at(0), at(1), at(2)});
}

double BoundForecast::total() const {
  double sum = 0;
  for (const TriangleId t : ids_of(mesh_.triangles)) {
    if (!mesh_.triangles[t].alive()) continue;
    sum += std::max(1.0, in(t, 2 * signed_area(mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2))));
  }
  return sum;
}

double BoundForecast::asked() const {
  double sum = 0;
  for (const TriangleId t : ids_of(mesh_.triangles))
    if (mesh_.triangles[t].alive())
      sum += in(t, 2 * signed_area(mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2)));
  return sum;
}

/// Pieces of a triangle are no smaller than half of what the least length asks for unless the field varies there
/// without falling that low, and each counts for what it asks or for a triangle.
double most_in_total(const Triangulation& mesh, const SizeBounds& sizes) {
  constexpr double kPiecesPerTriangle = 2.5;
  const double by_place = sizes.by_place() ? twice_area_of_edge(sizes.least_length()) : kNoBound;
  const double floor = sizes.step() != nullptr ? twice_area_of_edge(sizes.step()->least_floor()) : 0;
  const double least =
      std::max(floor, std::min(by_place, AreaBounds(mesh, sizes, kMarginOfRefinement).least_constant()));
  const double twice = 2 * area_of(mesh);
  return static_cast<double>(mesh.live_triangles()) + kPiecesPerTriangle / kMeanArea * twice / least;
}

}  // namespace driftmesh
