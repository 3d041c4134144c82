#pragma once

#include <cstdint>
#include <vector>

#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// A line of segments that follow each other: between two points that must stay, or closed.
struct Polyline {
  std::vector<std::int32_t> points;  ///< in order; of a closed one, the first is not repeated
  std::vector<std::int32_t>
      segments;         ///< segments[i] joins points[i] and the next; of a closed one, the last and the first
  bool closed = false;  ///< none of its points must stay
};

/// The lines of a repaired input; each segment is in one of them. A point must stay unless exactly two segments end
/// there, with the same marker, and both other ends have its point marker. In the order of their first segments.
[[nodiscard]] std::vector<Polyline> polylines_of(const Pslg& pslg);

}  // namespace driftmesh
