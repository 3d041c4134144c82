#pragma once

#include <vector>

#include "driftmesh/point.hpp"
#include "sizing/medial_axis.hpp"

namespace driftmesh {

/// A connected part of a domain that is narrower than a limit.
struct Creek {
  Point at{};         ///< in the middle between its banks, where it is narrowest
  double width = 0;   ///< there
  double length = 0;  ///< along the middle, with all its arms
};

/// All parts that are narrower than a width, as medial_axis() measures it; the narrowest first.
[[nodiscard]] std::vector<Creek> find_creeks(OutlineSegments outline, double width);

}  // namespace driftmesh
