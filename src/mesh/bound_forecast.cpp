#include "mesh/bound_forecast.hpp"

#include <algorithm>
#include <array>

#include "geometry/midpoint.hpp"

namespace driftmesh {
namespace {

/// The mean area of triangles relative to the bound, measured for area-bounded refinement.
constexpr double kMeanArea = 0.645;

constexpr double kNotAsked = 0;  // no length

/// How many triangles lengths ask for in a triangle, with their values at the corners: the integral of one over the
/// mean area, by subdivision until lengths vary little or the pieces are about as small as the triangles asked for.
/// Where lengths fall between the points that were looked at, so steeply that the mesh cannot follow, each piece
/// counts at least like a triangle. No point is asked for twice.
double integrate_size(const SizeBounds& sizes, double twice_area_bound, const CornerPoints& corners,
                      const std::array<double, 3>& at_corners, int depth = 0, bool steep = false) {
  const auto& [a, b, c] = corners;
  const auto& [at_a, at_b, at_c] = at_corners;
  const double in_middle = sizes.length_at(centroid(corners));
  const auto [least, most] = std::minmax({at_a, at_b, at_c, in_middle});
  const double twice = 2 * signed_area(a, b, c);
  constexpr int kDeepest = 8, kDeepestSteep = 14;
  constexpr double kSmooth = 1.6;
  if (depth >= kDeepest || most <= kSmooth * least || twice < 4 * twice_area_of_edge(least)) {
    const bool falls = depth < kDeepestSteep && sizes.falls_below(corners, std::min(least, edge_of_twice_area(twice)));
    const auto density = [&](double h) { return 1 / std::min(twice_area_of_edge(h), twice_area_bound); };
    const double mean = (density(at_a) + density(at_b) + density(at_c) + 9 * density(in_middle)) / 12;
    const double count = twice / kMeanArea * mean;
    if (!falls) return steep ? std::max(count, 1 / kMeanArea) : count;
    steep = true;
  }
  const Point ab = midpoint(a, b), bc = midpoint(b, c), ca = midpoint(c, a);
  const double at_ab = sizes.length_at(ab), at_bc = sizes.length_at(bc), at_ca = sizes.length_at(ca);
  const auto in = [&](const CornerPoints& part, const std::array<double, 3>& at) {
    return integrate_size(sizes, twice_area_bound, part, at, depth + 1, steep);
  };
  double sum = 0;
  sum += in({a, ab, ca}, {at_a, at_ab, at_ca});
  sum += in({ab, b, bc}, {at_ab, at_b, at_bc});
  sum += in({ca, bc, c}, {at_ca, at_bc, at_c});
  sum += in({bc, ca, ab}, {at_bc, at_ca, at_ab});
  return sum;
}

}  // namespace

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
  if (!areas_.by_place()) return twice_area / (kMeanArea * areas_.constant(t));
  const auto& v = mesh_.triangles[t].vertex;
  return integrate_size(areas_.sizes(), areas_.constant(t),
                        {mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2)},
                        {at_vertices_[v[0]], at_vertices_[v[1]], at_vertices_[v[2]]});
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

/// Pieces of a triangle are no smaller than a quarter of what the least length asks for unless the field varies there
/// without falling that low, and each counts for what it asks or for a triangle.
double most_in_total(const Triangulation& mesh, const SizeBounds& sizes) {
  constexpr double kPiecesPerTriangle = 5;
  const double by_place = sizes.by_place() ? twice_area_of_edge(sizes.least_length()) : kNoBound;
  const double least = std::min(by_place, AreaBounds(mesh, sizes, kMarginOfRefinement).least_constant());
  double twice = 0;
  for (const TriangleId t : ids_of(mesh.triangles))
    if (mesh.triangles[t].alive()) twice += 2 * signed_area(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2));
  return static_cast<double>(mesh.live_triangles()) + kPiecesPerTriangle / kMeanArea * twice / least;
}

}  // namespace driftmesh
