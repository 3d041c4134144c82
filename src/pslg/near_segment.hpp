#pragma once

#include <algorithm>
#include <cmath>

#include "geometry/box.hpp"

namespace driftmesh {

/// Accepts the boxes near a segment: those that meet its bounding box and do not lie entirely on one side of its line.
/// Rounding errors can only make it accept more.
class NearSegment {
 public:
  /// Near: up to `margin`.
  NearSegment(const Point& a, const Point& b, double margin)
      : a_(a), dx_(b.x - a.x), dy_(b.y - a.y), box_(Box::around(a, b, margin)) {
    const double reach = std::fabs(dx_) + std::fabs(dy_);
    slack_ = 2 * margin * reach + 1e-14 * reach * reach;
  }
  bool operator()(const Box& other) const {
    if (!box_.overlaps(other)) return false;
    const double x0 = std::max(box_.low.x, other.low.x) - a_.x, x1 = std::min(box_.high.x, other.high.x) - a_.x;
    const double y0 = std::max(box_.low.y, other.low.y) - a_.y, y1 = std::min(box_.high.y, other.high.y) - a_.y;
    const auto [low_y, high_y] = std::minmax({dx_ * y0, dx_ * y1});
    const auto [low_x, high_x] = std::minmax({dy_ * x0, dy_ * x1});
    return low_y - high_x <= slack_ && high_y - low_x >= -slack_;
  }

 private:
  Point a_;
  double dx_, dy_;
  double slack_ = 0;
  Box box_;
};

}  // namespace driftmesh
