#pragma once

#include <cstdint>

namespace driftmesh {

/// Counts of what the refinement of a mesh has done so far. They only increase, and stay with the mesh when it sleeps
/// or moves to another rank.
struct RefineCounters {
  std::int64_t free_points = 0;     ///< circumcenters and off-centers inserted
  std::int64_t segment_points = 0;  ///< midpoints inserted
  std::int64_t deleted_points = 0;  ///< free vertices deleted before a split
  std::int64_t encroaching = 0;     ///< points rejected because they encroached
  std::int64_t given_up = 0;        ///< triangles left as they are because coordinates are too coarse for another point
};

}  // namespace driftmesh
