#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "driftmesh/point.hpp"

namespace driftmesh {

/// Finds points by their exact coordinates. 8 to 16 bytes per point.
class PointIndex {
 public:
  /// `points` must outlive the index.
  explicit PointIndex(std::span<const Point> points);

  /// Adds points[i]; returns i, or the number of the point that was added before with the same coordinates.
  std::int32_t add(std::int32_t i);
  /// The number of the point with these coordinates, or kNone.
  [[nodiscard]] std::int32_t find(const Point& p) const { return slots_[slot_of(p)]; }

 private:
  [[nodiscard]] std::size_t slot_of(const Point& p) const;

  std::span<const Point> points_;
  std::vector<std::int32_t> slots_;  // open addressing, a power of two at least twice the points
};

}  // namespace driftmesh
