#pragma once

#include <cstdint>

#include "driftmesh/defaults.hpp"

namespace driftmesh {

/// The length of a triangle that a Courant number is about.
enum class CourantLength : std::uint8_t {
  kEdge,      ///< its shortest edge, as for finite elements
  kAltitude,  ///< its shortest altitude, as for finite volumes
};

/// The time step that the triangles of a mesh are to allow. The Courant number of a triangle is
/// step (sqrt(g H) + speed) / l, where g is 9.81 m/s^2, H the greatest depth anywhere in it, in meters and at least
/// 1 m, and l its length.
///
/// \code
/// const driftmesh::CourantRule rule{.step = 8, .speed = 1.5, .length = driftmesh::CourantLength::kAltitude};
/// assert(rule.bound == driftmesh::defaults::kCourant);
/// \endcode
struct CourantRule {
  double step = 0;                    ///< seconds; 0: none is asked for
  double bound = defaults::kCourant;  ///< largest Courant number, > 0
  double speed = 0;                   ///< the speed of a current that waves travel with, in m/s, >= 0
  CourantLength length = CourantLength::kEdge;
};

}  // namespace driftmesh
