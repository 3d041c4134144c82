#include "mesh/exceptions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/triangle_geometry.hpp"
#include "mesh/corners.hpp"

namespace driftmesh {
namespace {

constexpr auto id = &Triangulation::id;
constexpr double kDegrees = 180 / std::numbers::pi;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

/// The corner opposite to the shortest edge.
int apex_of_shortest_edge(const Triangulation& mesh, TriangleId t) {
  std::array<double, 3> squared{};
  for (int i = 0; i < 3; ++i) squared[at(i)] = squared_distance(mesh.corner(t, next(i)), mesh.corner(t, previous(i)));
  return static_cast<int>(std::min_element(squared.begin(), squared.end()) - squared.begin());
}

double area_bound(const Triangulation& mesh, const QualityBounds& bounds, TriangleId t) {
  double bound = bounds.max_area > 0 ? bounds.max_area : kNoBound;
  if (!bounds.region_max_area.empty() && !mesh.region.empty()) {
    const double own = bounds.region_max_area[mesh.region[id(t)]];
    if (own > 0) bound = std::min(bound, own);
  }
  if (bounds.size == nullptr) return bound;
  Point centroid{0, 0};
  double h = kNoBound;
  for (int i = 0; i < 3; ++i) {
    const Point& p = mesh.corner(t, i);
    centroid = {centroid.x + p.x / 3, centroid.y + p.y / 3};
    h = std::min(h, bounds.size->edge_length(p));
  }
  return std::min(bound, twice_area_of_edge(std::min(h, bounds.size->edge_length(centroid))) / 2);
}

/// Bins of 10 degrees by the cosine, without a trigonometric function for each of millions of angles.
class CosineBins {
 public:
  CosineBins() {
    for (std::size_t i = 0; i < limits_.size(); ++i) limits_[i] = std::cos(static_cast<double>(i + 1) * 10 / kDegrees);
  }
  [[nodiscard]] std::size_t bin(double cosine) const {
    const auto it = std::find_if(limits_.begin(), limits_.end(), [&](double limit) { return cosine > limit; });
    return static_cast<std::size_t>(it - limits_.begin());
  }

 private:
  std::array<double, 17> limits_{};
};

}  // namespace

ExceptionCause cause_of(const Triangulation& mesh, TriangleId t) {
  const Triangle& triangle = mesh.triangles[id(t)];
  const int i = apex_of_shortest_edge(mesh, t);
  if (is_constrained(triangle.neighbor[at(next(i))]) && is_constrained(triangle.neighbor[at(previous(i))]))
    return ExceptionCause::kInputAngle;
  return on_same_shell(mesh, triangle.vertex[at(next(i))], triangle.vertex[at(previous(i))])
             ? ExceptionCause::kShell
             : ExceptionCause::kUnexplained;
}

Exceptions find_exceptions(const Triangulation& mesh, const QualityBounds& bounds) {
  Exceptions found;
  const double sine = std::sin(bounds.min_angle / kDegrees);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (!mesh.triangles[i].alive()) continue;
    const auto t = static_cast<TriangleId>(i);
    const Point &a = mesh.corner(t, 0), &b = mesh.corner(t, 1), &c = mesh.corner(t, 2);
    const double ab = squared_distance(a, b), bc = squared_distance(b, c), ca = squared_distance(c, a);
    const double twice_area = 2 * signed_area(a, b, c);
    // The sine of the smallest angle is twice the area over the product of the two longer edges.
    if (twice_area * twice_area * std::min({ab, bc, ca}) < sine * sine * (ab * bc * ca)) {
      const ExceptionCause cause = cause_of(mesh, t);
      found.skinny.push_back({t, cause == ExceptionCause::kUnexplained ? ExceptionCause::kPrecision : cause,
                              angle_range(a, b, c).smallest * kDegrees});
    }
    if (twice_area > 2 * area_bound(mesh, bounds, t)) found.large.push_back(t);
  }
  return found;
}

AngleSummary summarize_angles(const Triangulation& mesh) {
  AngleSummary summary;
  summary.smallest_area = kNoBound;
  const CosineBins bins;
  double least_cosine = 1, greatest_cosine = -1;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (!mesh.triangles[i].alive()) continue;
    const auto t = static_cast<TriangleId>(i);
    const Point* p[3] = {&mesh.corner(t, 0), &mesh.corner(t, 1), &mesh.corner(t, 2)};
    double squared[3], root[3];
    for (int k = 0; k < 3; ++k) {
      squared[k] = squared_distance(*p[next(k)], *p[previous(k)]);
      root[k] = std::sqrt(squared[k]);
    }
    for (int k = 0; k < 3; ++k) {
      const double dot = squared[next(k)] + squared[previous(k)] - squared[k];  // law of cosines
      const double cosine = dot / (2 * root[next(k)] * root[previous(k)]);
      ++summary.bins[bins.bin(cosine)];
      least_cosine = std::min(least_cosine, cosine);
      greatest_cosine = std::max(greatest_cosine, cosine);
    }
    const double area = signed_area(*p[0], *p[1], *p[2]);
    summary.total_area += area;
    summary.smallest_area = std::min(summary.smallest_area, area);
    summary.largest_area = std::max(summary.largest_area, area);
  }
  summary.smallest = std::acos(std::clamp(greatest_cosine, -1.0, 1.0)) * kDegrees;
  summary.largest = std::acos(std::clamp(least_cosine, -1.0, 1.0)) * kDegrees;
  return summary;
}

}  // namespace driftmesh
