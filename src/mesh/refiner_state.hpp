#pragma once

#include <cstdint>
#include <string>
#include <unordered_set>
#include <vector>

#include "base/growing_array.hpp"
#include "mesh/bounds.hpp"
#include "mesh/refine_counters.hpp"
#include "mesh/triangulation.hpp"
#include "mesh/worklist.hpp"

namespace driftmesh {

/// A point that refinement put on a root segment: what a SPLIT message says.
struct SplitPoint {
  RootId root;
  dyadic::Path path;
};

/// All that a refiner knows besides its mesh and its bounds. A refiner made from a copy of the mesh, the same bounds
/// and a copy of the state goes on exactly as the first one would: the same points in the same order.
struct RefinerState {
  enum class Stage : std::uint8_t { kSegments, kCoarse, kFine, kRest, kDone };

  Stage stage = Stage::kSegments;
  SubsegmentId next_segment = 0;  ///< of kSegments
  Sweep sweep;
  SkinnyBuckets skinny;
  std::vector<TriangleId> deferred;               ///< skinny ones, until kRest
  std::unordered_set<SubsegmentId> unsplittable;  ///< coordinates have no room for their midpoints
  std::vector<SplitPoint> made;                   ///< that nobody has been told of yet
  GrowingArray<double> size;                      ///< the size field at each vertex; empty without one
  std::int64_t max_triangles = kMaxTriangles - 64;
  RefineCounters counters;

  /// Of a refiner that has done with `mesh`, whatever the order of its slots: nothing waits.
  [[nodiscard]] static RefinerState at_rest(const Triangulation& mesh, const QualityBounds& bounds);

  /// Whether a refiner of this mesh and these bounds can be in this state as far as memory is concerned: handles
  /// exist, arrays have their lengths. Otherwise what is wrong; empty if all is well.
  [[nodiscard]] std::string fault(const Triangulation& mesh, const QualityBounds& bounds) const;
};

}  // namespace driftmesh
