#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/disjoint_sets.hpp"
#include "driftmesh/mesh.hpp"
#include "mesh/merge_pieces.hpp"
#include "verify/corner_table.hpp"
#include "verify/words.hpp"

namespace driftmesh {

/// What is left to check of a piece when its inside has been checked: its subsegments, and all triangles at points that
/// are on its rim, on a subsegment, or marked for another reason. Frames of all pieces joined are a small mesh that has
/// all triangles of the whole at these points.
struct Frame {
  Mesh mesh;  ///< points have numbers; no regions
  std::vector<TrianglePlace> places;
  std::vector<char> marks;          ///< for each point whether it is one of these
  std::vector<std::int32_t> parts;  ///< empty, or for each triangle that of the piece which it belongs to

  [[nodiscard]] NamedMesh named() const { return {mesh, places}; }
  /// The marked points, ascending.
  [[nodiscard]] std::vector<std::int32_t> marked() const;
};

/// The frame of a piece. `parts` may be null.
[[nodiscard]] Frame frame_of(const NamedMesh& piece, const CornerTable& corners, const std::vector<char>& marks,
                             DisjointSets<std::int32_t>* parts);

/// The frames of all pieces joined; adds where they contradict each other (see merge_pieces).
[[nodiscard]] Frame join_frames(std::span<Frame> frames, MergeFaults& faults);

}  // namespace driftmesh
