#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "driftmesh/point.hpp"
#include "geometry/hilbert.hpp"

namespace driftmesh {

/// Finds the triangle around a point by a short walk: from the triangle that is nearest along a Hilbert curve, across
/// edges that separate the current triangle from the point. The start depends on the point alone, and so does the
/// answer.
class TriangleWalk {
 public:
  using Triangle = std::array<std::int32_t, 3>;

  struct Found {
    std::int32_t triangle = -1;        ///< -1: not found
    std::array<double, 3> opposite{};  ///< orient2d of the point and the edge opposite each corner; all > 0
  };

  TriangleWalk() = default;
  /// Counterclockwise triangles; neighbors[t][i] is the triangle across the edge from corner i of t to the next, -1
  /// where there is none.
  TriangleWalk(const std::vector<Point>& points, const std::vector<Triangle>& triangles,
               const std::vector<Triangle>& neighbors);

  /// The triangle that has `p` in its interior; nothing if p lies on an edge, or if the walk meets the boundary or
  /// takes too many steps. Never a wrong triangle.
  [[nodiscard]] Found find(const Point& p) const;

 private:
  static constexpr int kMaxSteps = 100;
  // All that a step needs, in one cache line; sorted along the curve.
  struct alignas(64) Node {
    std::array<Point, 3> corner;
    std::array<std::int32_t, 3> next;  // node across the edge from corner i to the next
    std::int32_t triangle;
  };

  [[nodiscard]] std::size_t start_for(const Point& p) const;

  HilbertOrder order_{{0, 0}, {0, 0}};
  std::vector<Node> nodes_;
  std::vector<std::uint64_t> places_;  // nodes on the curve
  std::vector<std::uint32_t> bucket_;  // the first node whose place has these upper bits or higher ones
  int bucket_shift_ = 63;
};

}  // namespace driftmesh
