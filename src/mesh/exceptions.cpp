#include "mesh/exceptions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "geometry/triangle_geometry.hpp"
#include "mesh/corners.hpp"
#include "mesh/shape_columns.hpp"

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
    size_.assign(mesh.points.size(), kNotAsked);
  }

  /// Whether no triangle of this area, or of less, can be above its bound, wherever it is.
  [[nodiscard]] bool surely_kept_below(double twice_area) const {
    const bool one_bound = bounds_.size == nullptr && (bounds_.region_max_area.empty() || mesh_.region.empty());
    return one_bound && twice_area <= 2 * greatest_bound();
  }
  [[nodiscard]] bool exceeded(TriangleId t, double twice_area) {
    return twice_area > 2 * constant_bound(t) ||
           (bounds_.size != nullptr && twice_area > twice_area_of_least_ && too_large_for_size(t, twice_area));
  }

 private:
  [[nodiscard]] double greatest_bound() const { return bounds_.max_area > 0 ? bounds_.max_area : kNoBound; }

  [[nodiscard]] double constant_bound(TriangleId t) const {
    const double bound = greatest_bound();
    if (bounds_.region_max_area.empty() || mesh_.region.empty()) return bound;
    const double own = bounds_.region_max_area[mesh_.region[t]];
    return own > 0 ? std::min(bound, own) : bound;
  }

  [[nodiscard]] bool too_large_for_size(TriangleId t, double twice_area) {
    const CornerPoints corners{mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2)};
    if (twice_area <= twice_area_of_edge(bounds_.size->least_near(corners))) return false;
    double h = std::numeric_limits<double>::infinity();
    for (const VertexId v : mesh_.triangles[t].vertex) h = std::min(h, size_at(v));
    if (twice_area > twice_area_of_edge(h)) return true;
    if (twice_area <= twice_area_of_edge(bounds_.size->least_between(corners, h))) return false;
    h = std::min(h, bounds_.size->edge_length(centroid(corners)));
    return twice_area > twice_area_of_edge(h) || bounds_.size->falls_below(corners, edge_of_twice_area(twice_area));
  }

  [[nodiscard]] double size_at(VertexId v) {
    if (size_[v] == kNotAsked) size_[v] = bounds_.size->edge_length(mesh_.points[v]);
    return size_[v];
  }

  static constexpr double kNotAsked = 0;  // no value of a size field
  const Triangulation& mesh_;
  const QualityBounds& bounds_;
  double twice_area_of_least_ = 0;
  IdVector<VertexId, double> size_;  // of the field at each vertex, where it was needed
};

/// Calls visit(triangles, shapes) for the live triangles in their order, block by block. Corners are prefetched some
/// triangles ahead: otherwise most of the time would be spent waiting for memory.
template <class Visit>
void visit_blocks(const Triangulation& mesh, const Visit& visit) {
  constexpr std::int32_t kAhead = 16;
  std::array<TriangleId, ShapeColumns::kMost> block;
  ShapeColumns shapes;
  for (const TriangleId t : ids_of(mesh.triangles)) {
    const TriangleId ahead{to_int(t) + kAhead};
    if (mesh.triangles.has(ahead) && mesh.triangles[ahead].alive())
      for (const VertexId v : mesh.triangles[ahead].vertex) __builtin_prefetch(&mesh.points[v]);
    if (!mesh.triangles[t].alive()) continue;
    block[shapes.size()] = t;
    shapes.add(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2));
    if (!shapes.full()) continue;
    visit(std::span<const TriangleId>(block), shapes);
    shapes.clear();
  }
  if (shapes.size() > 0) visit(std::span<const TriangleId>(block).first(shapes.size()), shapes);
}

/// The angle, in degrees, of a signed squared cosine.
double degrees_of(double signed_cosine_squared) {
  const double c = std::clamp(signed_cosine_squared, -1.0, 1.0);
  return std::acos(std::copysign(std::sqrt(std::abs(c)), c)) * kDegrees;
}

Exceptions::Item skinny_item(const Triangulation& mesh, TriangleId t) {
  const ExceptionCause cause = cause_of(mesh, t);
  return {t, cause == ExceptionCause::kUnexplained ? ExceptionCause::kPrecision : cause,
          angle_range(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)).smallest * kDegrees};
}

}  // namespace

ExceptionCause cause_of(const Triangulation& mesh, TriangleId t) {
  const Triangle& triangle = mesh.triangles[t];
  const int i = apex_of_shortest_edge(mesh, t);
  if (is_constrained(triangle.neighbor[next(i)]) && is_constrained(triangle.neighbor[previous(i)]))
    return ExceptionCause::kInputAngle;
  return on_same_shell(mesh, triangle.vertex[next(i)], triangle.vertex[previous(i)]) ? ExceptionCause::kShell
                                                                                     : ExceptionCause::kUnexplained;
}

Inspection inspect(const Triangulation& mesh, const QualityBounds& bounds) {
  Inspection found;
  const double sine = std::sin(bounds.min_angle / kDegrees);
  AreaBounds areas(mesh, bounds);
  double least_cosine = 1, greatest_cosine = -1;
  double least_area = kNoBound, greatest_area = 0;  // twice
  visit_blocks(mesh, [&](std::span<const TriangleId> block, ShapeColumns& shapes) {
    const ShapeColumns::Summary sum = shapes.measure(sine);
    least_cosine = std::min(least_cosine, sum.least_cosine);
    greatest_cosine = std::max(greatest_cosine, sum.greatest_cosine);
    least_area = std::min(least_area, sum.least_twice_area);
    greatest_area = std::max(greatest_area, sum.greatest_twice_area);
    found.shape.total_area += sum.twice_area / 2;
    for (std::size_t i = 0; i < sum.angles.size(); ++i) found.shape.bins[i] += sum.angles[i];
    if (sum.least_margin < 0)
      for (std::size_t k = 0; k < block.size(); ++k)
        if (shapes.is_skinny(k)) found.exceptions.skinny.push_back(skinny_item(mesh, block[k]));
    if (areas.surely_kept_below(sum.greatest_twice_area)) return;
    for (std::size_t k = 0; k < block.size(); ++k)
      if (areas.exceeded(block[k], shapes.twice_area(k))) found.exceptions.large.push_back(block[k]);
  });
  found.shape.smallest = degrees_of(greatest_cosine);
  found.shape.largest = degrees_of(least_cosine);
  found.shape.smallest_area = least_area / 2;
  found.shape.largest_area = greatest_area / 2;
  return found;
}

}  // namespace driftmesh
