#include "mesh/exceptions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "geometry/triangle_geometry.hpp"
#include "mesh/area_bounds.hpp"
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

/// The lengths that are asked for at vertices, each looked up once, when it is needed.
class SizeAtVertices {
 public:
  SizeAtVertices(const Triangulation& mesh, const SizeBounds& sizes)
      : mesh_(mesh), sizes_(sizes), values_(sizes.by_place() ? mesh.points.size() : 0, kNotAsked) {}

  [[nodiscard]] double least_at_corners(TriangleId t) {
    double least = std::numeric_limits<double>::infinity();
    for (const VertexId v : mesh_.triangles[t].vertex) least = std::min(least, at(v));
    return least;
  }

 private:
  [[nodiscard]] double at(VertexId v) {
    if (values_[v] == kNotAsked) values_[v] = sizes_.length_at(mesh_.points[v]);
    return values_[v];
  }

  static constexpr double kNotAsked = 0;  // no length
  const Triangulation& mesh_;
  const SizeBounds& sizes_;
  IdVector<VertexId, double> values_;
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
  const AreaBounds areas(mesh, bounds);
  SizeAtVertices sizes(mesh, areas.sizes());
  const auto is_large = [&](TriangleId t, double twice_area) {
    const CornerPoints corners{mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)};
    const bool above = twice_area > areas.constant(t) ||
                       (areas.by_place() && areas.above_size(
                                                corners, twice_area, [&] { return sizes.least_at_corners(t); }, true));
    return above && !areas.sizes().spares_thinned(corners, twice_area);
  };
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
    if (areas.surely_hold(sum.greatest_twice_area)) return;
    for (std::size_t k = 0; k < block.size(); ++k)
      if (is_large(block[k], shapes.twice_area(k))) found.exceptions.large.push_back(block[k]);
  });
  found.shape.smallest = degrees_of(greatest_cosine);
  found.shape.largest = degrees_of(least_cosine);
  found.shape.smallest_area = least_area / 2;
  found.shape.largest_area = greatest_area / 2;
  return found;
}

}  // namespace driftmesh
