#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "driftmesh/pslg.hpp"

namespace driftmesh {

// Words for messages, with the numbers that the user's file uses.

/// "(x, y)" with as many digits as the coordinates need.
[[nodiscard]] std::string coordinates(const Point& p);
/// "vertex 17 (x, y)"; `index` is that of the point as it was read, -1 for a point that repair added.
[[nodiscard]] std::string vertex_name(const Pslg& pslg, std::int32_t index, const Point& p);
/// A length with three significant digits.
[[nodiscard]] std::string length_text(double length);
/// "segment 12".
[[nodiscard]] std::string segment_name(const Pslg& pslg, std::int32_t index);
/// "feature 3", or "polygon 7" for one without a feature.
[[nodiscard]] std::string polygon_name(const Pslg& pslg, std::size_t index);

}  // namespace driftmesh
