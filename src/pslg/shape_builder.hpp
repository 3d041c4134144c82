#pragma once

#include <string>
#include <vector>

#include "driftmesh/pslg.hpp"

namespace driftmesh {

using Chain = std::vector<Point>;

inline constexpr double kPi = 3.14159265358979323846;

/// Throws InputError("generate KIND: <what>") unless the condition holds.
void require_option(bool condition, const std::string& kind, const std::string& what);

/// The number of edges that cut a curve of this length into pieces no longer than `edge`; at least `least`.
[[nodiscard]] std::int32_t edges_for(double length, double edge, std::int32_t least);

/// Points on a circle from angle `from` to angle `to` in radians; the last is left out if it would close the circle.
[[nodiscard]] Chain arc(const Point& center, double radius, double from, double to, std::int32_t edges);

/// Appends points on the straight line from the end of `chain` to `to`, which is the last of them.
void line_to(Chain& chain, Point to, double edge);

/// Adds points to `pslg` and joins them to form a closed loop.
void add_loop(Pslg& pslg, const Chain& loop, std::int32_t marker);

/// Checks with repair() that the generated graph is planar. Throws InputError if the options made it overlap itself.
[[nodiscard]] Pslg checked(Pslg pslg, const std::string& kind);

}  // namespace driftmesh
