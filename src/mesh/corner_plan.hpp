#pragma once

#include <cstdint>
#include <vector>

#include "driftmesh/point.hpp"
#include "mesh/corners.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

/// One end of a root segment that is still whole: 2 * root + side (0: start, 1: end).
enum class SegmentEnd : std::int32_t {};

[[nodiscard]] constexpr SegmentEnd segment_end(RootId root, int side) {
  return SegmentEnd{2 * to_int(root) + side};
}
[[nodiscard]] constexpr RootId root_of(SegmentEnd e) {
  return RootId{to_int(e) / 2};
}
[[nodiscard]] constexpr int side_of(SegmentEnd e) {
  return to_int(e) % 2;
}
[[nodiscard]] constexpr SegmentEnd other_end(SegmentEnd e) {
  return SegmentEnd{to_int(e) ^ 1};
}

/// Where to cut the segments that meet at acute corners, and which pieces then lie between the same two circles around
/// an apex (a shell). See corners.hpp.
struct CornerPlan {
  struct Cut {
    SegmentEnd end;       ///< the segment's end at the apex
    Point at;             ///< on the segment
    std::int32_t shell;   ///< for the piece between this cut and the one before it, or the apex
    std::int32_t circle;  ///< names the new vertex: shared with those that it forms a seditious pair with
  };
  std::vector<Cut> cuts;  ///< those of one end nearest to the apex first

  /// The outermost piece of a segment whose far end lies on a circle at which other segments are cut, too.
  struct TipPiece {
    SegmentEnd end;
    std::int32_t shell;
  };
  std::vector<TipPiece> tips;
  std::int32_t clusters = 0;  ///< groups of segments that meet at less than 60 degrees, cut or not
};

/// `fixed`: roots that form no corners, one entry for each root; empty: none.
[[nodiscard]] CornerPlan plan_corners(const Triangulation& mesh, const CornerUse& use,
                                      const IdVector<RootId, bool>& fixed);

}  // namespace driftmesh
