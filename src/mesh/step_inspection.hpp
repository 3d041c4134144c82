#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesh/triangulation.hpp"
#include "sizing/time_step.hpp"

namespace driftmesh {

/// Why a triangle does not allow a time step.
enum class StepCause : std::uint8_t {
  kSegment,  ///< its shortest edge is a whole segment of the input, or a piece of one at an acute corner
  kHalf,     ///< its shortest edge is a part of a segment that refinement has split
  kBetween,  ///< its shortest edge joins points on segments
  kAngles,   ///< anything else: deleting the vertex would make too small angles or too large triangles
};
inline constexpr std::size_t kStepCauses = 4;

/// A triangle that does not allow a time step.
struct StepMiss {
  TriangleId triangle;
  StepCause cause;
  double room;    ///< the step that it allows over the one asked for
  double needed;  ///< how long its shortest edge, or altitude, should be
};

struct StepInspection {
  double least_room;  ///< the least of all triangles
  std::vector<StepMiss> misses;
};
/// Examines every triangle anew.
[[nodiscard]] StepInspection inspect_step(const Triangulation& mesh, const TimeStep& step);

}  // namespace driftmesh
