#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "driftmesh/point.hpp"

namespace driftmesh {

/// The corners of a polygon in order, without the first one again at the end.
using PolygonRing = std::vector<Point>;

/// Calls visit(a, b) for each edge of the rings.
template <class Visit>
void for_each_edge(std::span<const PolygonRing* const> rings, const Visit& visit) {
  for (const PolygonRing* ring : rings)
    for (std::size_t i = 0; i < ring->size(); ++i) visit((*ring)[i], (*ring)[i + 1 == ring->size() ? 0 : i + 1]);
}

/// Whether the line at height y passes between a and b; of the two ends, it belongs to the upper one.
[[nodiscard]] inline bool spans_height(const Point& a, const Point& b, double y) {
  return (a.y <= y) != (b.y <= y);
}

/// Whether an odd number of the rings encloses `p`. Exact, except on the rings themselves.
[[nodiscard]] bool is_inside(std::span<const PolygonRing* const> rings, const Point& p);

}  // namespace driftmesh
