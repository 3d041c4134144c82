#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bench/mesher.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh::bench {

/// Area and squared sine of the smallest angle of a triangle, the quantities that are bounded, computed without square
/// roots.
struct Shape {
  double area = 0;
  double squared_sine = 0;
};

[[nodiscard]] inline Shape shape_of(const Point& a, const Point& b, const Point& c) {
  const double area = signed_area(a, b, c);
  const double ab = squared_distance(a, b), bc = squared_distance(b, c), ca = squared_distance(c, a);
  const double shortest = std::min({ab, bc, ca});
  return {area, 4 * area * area * shortest / (ab * bc * ca)};
}

/// Counts triangles and keeps their extremes.
class ShapeCensus {
 public:
  void add(const Shape& shape) {
    ++triangles_;
    largest_area_ = std::max(largest_area_, shape.area);
    squared_sine_ = std::min(squared_sine_, shape.squared_sine);
  }
  void store(MeshRun& run) const {
    run.triangles = triangles_;
    run.largest_area = largest_area_;
    run.smallest_angle = std::asin(std::sqrt(squared_sine_)) * 180 / std::numbers::pi;
  }

 private:
  std::int64_t triangles_ = 0;
  double largest_area_ = 0;
  double squared_sine_ = 0.75;  // 60 degrees
};

}  // namespace driftmesh::bench
