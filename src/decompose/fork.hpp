#pragma once

#include <array>
#include <optional>

#include "decompose/outline.hpp"
#include "driftmesh/point.hpp"

namespace driftmesh {

/// Three straight separators from a point inside a piece to its border: for pieces in which no straight cut is fair,
/// such as triangles with equal sides.
struct Fork {
  Point center;
  std::array<Outline::Station, 3> ends;  ///< in the order of the border, on three walls
};

/// The best fork from the centroid of a piece into three parts of about equal area, with short separators. All angles
/// at the center are at least `angle` (radians), those at the border as the stations allow. None if parts of the border
/// cannot be seen from the centroid, or if there is no such fork.
[[nodiscard]] std::optional<Fork> find_fork(const Outline& outline, double angle);

}  // namespace driftmesh
