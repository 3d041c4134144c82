#include "mesh/bound_forecast.hpp"

#include <algorithm>

#include "geometry/midpoint.hpp"

namespace driftmesh {
namespace {

/// The mean area of triangles relative to the bound, measured for area-bounded refinement.
constexpr double kMeanArea = 0.645;

/// How many triangles a size field asks for in a triangle: the integral of one over the mean area, by subdivision until
/// the field varies little or the pieces are about as small as the triangles asked for. Where the field falls between
/// the points that were looked at, so steeply that the mesh cannot follow, each piece counts at least like a triangle.
double integrate_size(const SizeField& field, double twice_area_bound, const CornerPoints& corners, int depth = 0,
                      bool steep = false) {
  const auto& [a, b, c] = corners;
  const Point middle = centroid(corners);
  const double h[4] = {field.edge_length(a), field.edge_length(b), field.edge_length(c), field.edge_length(middle)};
  const auto [least, most] = std::minmax({h[0], h[1], h[2], h[3]});
  const double twice = 2 * signed_area(a, b, c);
  constexpr int kDeepest = 8, kDeepestSteep = 14;
  constexpr double kSmooth = 1.2;
  if (depth >= kDeepest || most <= kSmooth * least || twice < 4 * twice_area_of_edge(least)) {
    const bool falls = depth < kDeepestSteep && field.falls_below(corners, std::min(least, edge_of_twice_area(twice)));
    const double mean = (h[0] + h[1] + h[2] + 3 * h[3]) / 6;
    const double count = twice / (kMeanArea * std::min(twice_area_of_edge(mean), twice_area_bound));
    if (!falls) return steep ? std::max(count, 1 / kMeanArea) : count;
    steep = true;
  }
  const Point ab = midpoint(a, b), bc = midpoint(b, c), ca = midpoint(c, a);
  double sum = 0;
  for (const CornerPoints& part : {CornerPoints{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {bc, ca, ab}})
    sum += integrate_size(field, twice_area_bound, part, depth + 1, steep);
  return sum;
}

}  // namespace

std::vector<double> twice_area_bounds(const QualityBounds& bounds) {
  const auto twice = [](double area) { return area > 0 ? 2 * area * (1 - 1e-12) : kNoBound; };
  std::vector<double> by_region{twice(bounds.max_area)};
  for (std::size_t r = 1; r < bounds.region_max_area.size(); ++r)
    by_region.push_back(std::min(twice(bounds.max_area), twice(bounds.region_max_area[r])));
  return by_region;
}

BoundForecast::BoundForecast(const Triangulation& mesh, const QualityBounds& bounds)
    : mesh_(mesh), size_(bounds.size), twice_area_bounds_(twice_area_bounds(bounds)) {}

double BoundForecast::twice_area_bound(TriangleId t) const {
  return twice_area_bounds_.size() > 1 && !mesh_.region.empty() ? twice_area_bounds_[mesh_.region[t]]
                                                                : twice_area_bounds_[0];
}

double BoundForecast::in(TriangleId t, double twice_area) const {
  if (size_ == nullptr) return twice_area / (kMeanArea * twice_area_bound(t));
  return integrate_size(*size_, twice_area_bound(t), {mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2)});
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

bool BoundForecast::any() const {
  return size_ != nullptr || std::ranges::any_of(twice_area_bounds_, [](double bound) { return bound < kNoBound; });
}

}  // namespace driftmesh
