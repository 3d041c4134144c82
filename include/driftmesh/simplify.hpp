#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// What simplify() removed.
struct SimplifyReport {
  std::int64_t points = 0;  ///< removed from lines, without those of dropped rings
  std::int64_t rings = 0;   ///< dropped as too small, with their seeds
  /// For each point of the result, its index before.
  std::vector<std::int32_t> original_point;
};

/// Removes points of lines that need not be there if lines may move by `tolerance`, a length: what is left are some of
/// the points, joined by straight segments.
/// - Every point that was removed from a line is within `tolerance` of the segment that replaces its part of the line,
///   and every point of that segment within `tolerance` of the line.
/// - Lines do not cross, touch or change sides with each other, with isolated points, or with the seeds of holes and
///   regions; so holes remain holes, islands lie in the same water, and repair() has nothing to do.
/// - New segments do not come closer than a quarter of `tolerance` to points that were farther away, and keep nine
///   tenths of smaller distances. Lines do not turn sharper than 60 degrees where they did not.
/// - Ends of lines, points where three or more meet, and those where the marker of segments or points changes, stay.
/// - Closed rings without such points that fit into a square of side `tolerance`, with all that is inside, are dropped
///   with the seeds of holes and regions inside them. Rings of polygons lose the same points; a polygon without its
///   first ring is dropped.
/// Points, segments and seeds that remain keep their order, markers and attributes. Points with the smallest effect go
/// first (M. Visvalingam and J. Whyatt, "Line generalisation by repeated elimination of points", The Cartographic
/// Journal 30, 1993); the test whether one may go is local, since segments of a planar input can only cross a shortcut
/// over a point if something lies in the triangle that it cuts off.
///
/// `pslg` is as repair() leaves it. Throws Error for a tolerance that is negative or not finite, and InputError, naming
/// `file`, if nothing would be left of a domain.
///
/// \code
/// driftmesh::Pslg bay = driftmesh::generate("bay");  // lengths in meters
/// driftmesh::repair(bay);
/// const driftmesh::SimplifyReport report = driftmesh::simplify(bay, 500);
/// std::cout << report.points << " points and " << report.rings << " islands less, " << bay.points.size() << " left\n";
/// \endcode
SimplifyReport simplify(Pslg& pslg, double tolerance, const std::string& file = "input");

}  // namespace driftmesh
