#pragma once

#include <cstdint>
#include <string>
#include <unordered_set>
#include <vector>

#include "base/growing_array.hpp"
#include "dyadic/split_point.hpp"
#include "mesh/refine_counters.hpp"
#include "mesh/size_bound.hpp"
#include "mesh/triangulation.hpp"
#include "mesh/worklist.hpp"

namespace driftmesh {

/// The state of a refiner besides its mesh and its bounds. A refiner made from copies of mesh and state and the same
/// bounds continues exactly as the original would: the same points in the same order.
struct RefinerState {
  enum class Stage : std::uint8_t { kSegments, kCoarse, kFine, kRest, kDone };

  Stage stage = Stage::kSegments;
  SubsegmentId next_segment{0};  ///< next in kSegments
  Sweep sweep;
  SkinnyBuckets skinny;
  GrowingArray<TriangleId> deferred;              ///< skinny ones, until kRest
  std::unordered_set<SubsegmentId> unsplittable;  ///< coordinates are too coarse for their midpoints
  std::vector<SplitPoint<RootId>> made;           ///< split points not yet taken by take_split_points
  GrowingArray<double, VertexId> size;            ///< the length that is asked for at each vertex; empty if none is
  std::int64_t max_triangles = kMostRefined;
  RefineCounters counters;

  /// The state of a refiner that begins with `mesh`.
  [[nodiscard]] static RefinerState at_start(const Triangulation& mesh, const SizeBounds& sizes);
  /// The state of a refiner that has finished `mesh`, with no work queued: what it does when it is told of points is
  /// the same whatever the order of slots, and the corner at which each triangle begins.
  [[nodiscard]] static RefinerState at_rest(const Triangulation& mesh, const SizeBounds& sizes);

  /// The reason why this state would make a refiner of this mesh and these bounds access invalid memory: a handle that
  /// does not exist, or an array of the wrong length. Empty if the state is sound.
  [[nodiscard]] std::string fault(const Triangulation& mesh, const SizeBounds& sizes) const;
};

}  // namespace driftmesh
