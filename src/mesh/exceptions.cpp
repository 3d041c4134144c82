#include "mesh/exceptions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/triangle_geometry.hpp"
#include "mesh/corners.hpp"

namespace driftmesh {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

/// The corner opposite to the shortest edge.
int apex_of_shortest_edge(const Triangulation& mesh, TriangleId t) {
  std::array<double, 3> squared{};
  for (int i = 0; i < 3; ++i) squared[i] = squared_distance(mesh.corner(t, next(i)), mesh.corner(t, previous(i)));
  return static_cast<int>(std::min_element(squared.begin(), squared.end()) - squared.begin());
}

/// Decides which triangles are above their area bound.
class AreaBounds {
 public:
  AreaBounds(const Triangulation& mesh, const QualityBounds& bounds) : mesh_(mesh), bounds_(bounds) {
    if (bounds.size == nullptr) return;
    twice_area_of_least_ = twice_area_of_edge(bounds.size->least());
    size_.reserve(mesh.points.size());
    for (const Point& p : mesh.points) size_.push_back(bounds.size->edge_length(p));
  }

  [[nodiscard]] bool exceeded(TriangleId t, double twice_area) const {
    return twice_area > 2 * constant_bound(t) ||
           (bounds_.size != nullptr && twice_area > twice_area_of_least_ && too_large_for_size(t, twice_area));
  }

 private:
  [[nodiscard]] double constant_bound(TriangleId t) const {
    const double bound = bounds_.max_area > 0 ? bounds_.max_area : kNoBound;
    if (bounds_.region_max_area.empty() || mesh_.region.empty()) return bound;
    const double own = bounds_.region_max_area[mesh_.region[t]];
    return own > 0 ? std::min(bound, own) : bound;
  }

  [[nodiscard]] bool too_large_for_size(TriangleId t, double twice_area) const {
    const CornerPoints corners{mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2)};
    double h = bounds_.size->edge_length(centroid(corners));
    for (const VertexId v : mesh_.triangles[t].vertex) h = std::min(h, size_[v]);
    return twice_area > twice_area_of_edge(h) || bounds_.size->falls_below(corners, edge_of_twice_area(twice_area));
  }

  const Triangulation& mesh_;
  const QualityBounds& bounds_;
  double twice_area_of_least_ = 0;
  IdVector<VertexId, double> size_;  // of the field at each vertex
};

/// Calls visit(triangle, corner points) for every live triangle, in their order. Corners are prefetched some triangles
/// ahead: otherwise most of the time would be spent waiting for memory.
template <class Visit>
void visit_triangles(const Triangulation& mesh, Visit&& visit) {
  constexpr std::int32_t kAhead = 16;
  for (const TriangleId t : ids_of(mesh.triangles)) {
    const TriangleId ahead{to_int(t) + kAhead};
    if (mesh.triangles.has(ahead) && mesh.triangles[ahead].alive())
      for (const VertexId v : mesh.triangles[ahead].vertex) __builtin_prefetch(&mesh.points[v]);
    if (!mesh.triangles[t].alive()) continue;
    visit(t, std::array<const Point*, 3>{&mesh.corner(t, 0), &mesh.corner(t, 1), &mesh.corner(t, 2)});
  }
}

/// Signed squares of cosines order angles as the cosines do, without a square root.
double signed_square(double x) {
  return x * std::abs(x);
}

/// The angle, in degrees, of a signed squared cosine.
double degrees_of(double signed_cosine_squared) {
  const double c = std::clamp(signed_cosine_squared, -1.0, 1.0);
  return std::acos(std::copysign(std::sqrt(std::abs(c)), c)) * kDegrees;
}

/// Bins of 10 degrees by the signed squared cosine, without a trigonometric function, a search or a branch for each of
/// millions of angles: a table of narrow cells, each with at most one limit between two bins inside it.
class CosineBins {
 public:
  CosineBins() {
    for (std::size_t i = 0; i < 17; ++i)
      limits_[i] = signed_square(std::cos(static_cast<double>(i + 1) * 10 / kDegrees));
    limits_[17] = -2;  // no angle is past the last bin
    for (std::size_t cell = 0; cell < kCells; ++cell) {
      const double top = static_cast<double>(cell + 1) / kCellsPerUnit - 1;  // the smallest angles of the cell
      const auto it = std::find_if(limits_.begin(), limits_.end(), [&](double limit) { return top > limit; });
      first_[cell] = static_cast<std::uint8_t>(it - limits_.begin());
    }
  }
  [[nodiscard]] std::size_t bin(double signed_cosine_squared) const {
    const double place = (signed_cosine_squared + 1) * kCellsPerUnit;
    const auto cell = static_cast<std::size_t>(std::clamp(place, 0.0, kCells - 1.0));
    const std::size_t first = first_[cell];
    return first + (signed_cosine_squared <= limits_[first] ? 1 : 0);
  }

 private:
  static constexpr double kCellsPerUnit = 64;  // limits are at least 0.03 apart: at most one in a cell
  static constexpr std::size_t kCells = 128;
  std::array<double, 18> limits_{};
  std::array<std::uint8_t, kCells> first_{};
};

}  // namespace

ExceptionCause cause_of(const Triangulation& mesh, TriangleId t) {
  const Triangle& triangle = mesh.triangles[t];
  const int i = apex_of_shortest_edge(mesh, t);
  if (is_constrained(triangle.neighbor[next(i)]) && is_constrained(triangle.neighbor[previous(i)]))
    return ExceptionCause::kInputAngle;
  return on_same_shell(mesh, triangle.vertex[next(i)], triangle.vertex[previous(i)]) ? ExceptionCause::kShell
                                                                                     : ExceptionCause::kUnexplained;
}

Exceptions find_exceptions(const Triangulation& mesh, const QualityBounds& bounds) {
  Exceptions found;
  const double sine = std::sin(bounds.min_angle / kDegrees);
  const AreaBounds areas(mesh, bounds);
  visit_triangles(mesh, [&](TriangleId t, const std::array<const Point*, 3>& corner) {
    const Point &a = *corner[0], &b = *corner[1], &c = *corner[2];
    const double ab = squared_distance(a, b), bc = squared_distance(b, c), ca = squared_distance(c, a);
    const double twice_area = 2 * signed_area(a, b, c);
    // The sine of the smallest angle is twice the area over the product of the two longer edges.
    if (twice_area * twice_area < sine * sine * std::max({ab * bc, bc * ca, ca * ab})) {
      const ExceptionCause cause = cause_of(mesh, t);
      found.skinny.push_back({t, cause == ExceptionCause::kUnexplained ? ExceptionCause::kPrecision : cause,
                              angle_range(a, b, c).smallest * kDegrees});
    }
    if (areas.exceeded(t, twice_area)) found.large.push_back(t);
  });
  return found;
}

AngleSummary summarize_angles(const Triangulation& mesh) {
  AngleSummary summary;
  summary.smallest_area = kNoBound;
  const CosineBins bins;
  double least = 1, greatest = -1;  // signed squared cosines
  visit_triangles(mesh, [&](TriangleId, const std::array<const Point*, 3>& p) {
    std::array<double, 3> squared{};
    for (int k = 0; k < 3; ++k) squared[k] = squared_distance(*p[next(k)], *p[previous(k)]);
    for (int k = 0; k < 3; ++k) {
      const double v = squared[next(k)], w = squared[previous(k)];
      const double cosine = signed_square(v + w - squared[k]) / (4 * v * w);  // law of cosines
      ++summary.bins[bins.bin(cosine)];
      least = std::min(least, cosine);
      greatest = std::max(greatest, cosine);
    }
    const double area = signed_area(*p[0], *p[1], *p[2]);
    summary.total_area += area;
    summary.smallest_area = std::min(summary.smallest_area, area);
    summary.largest_area = std::max(summary.largest_area, area);
  });
  summary.smallest = degrees_of(greatest);
  summary.largest = degrees_of(least);
  return summary;
}

}  // namespace driftmesh
