#pragma once

#include <cstddef>
#include <vector>

#include "driftmesh/id_vector.hpp"
#include "driftmesh/point.hpp"
#include "geometry/box.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh::adapt {

/// How fast a function that is linear on triangles changes with distance, at most, in any box: by squares of a grid
/// that are as large as some triangles.
class Slopes {
 public:
  Slopes() = default;
  /// `slope`: that in each triangle. Free slots do not count.
  Slopes(const Triangulation& mesh, const IdVector<TriangleId, double>& slope);

  /// At least that of all triangles that overlap the box, if they cover it; that of all triangles for a box that is
  /// much larger than the squares, or has squares without any.
  [[nodiscard]] double most_in(const Box& box) const;
  [[nodiscard]] double most() const { return most_; }

 private:
  struct Squares {
    std::size_t left, right, bottom, top;  // both ends
    [[nodiscard]] std::size_t count() const { return (right - left + 1) * (top - bottom + 1); }
  };
  [[nodiscard]] Squares squares_of(const Box& box) const;

  double most_ = 0;
  Point low_{};
  double width_ = 1;
  std::size_t columns_ = 0, rows_ = 0;
  std::vector<float> at_;  // rounded up; negative: no triangle
};

}  // namespace driftmesh::adapt
