#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "driftmesh/mesh.hpp"
#include "verify/findings.hpp"

namespace driftmesh {

/// Layers of triangles across the channels of a mesh.
struct AcrossReport {
  std::size_t crossings = 0;    ///< that were looked at
  std::size_t too_narrow = 0;   ///< others, narrower than the limit
  int fewest = 0;               ///< layers at a crossing, or as many as are asked for if there are more
  std::size_t on_boundary = 0;  ///< triangles with all corners on the boundary
};

/// What is asked of crossings.
struct AcrossRule {
  int layers = 0;        ///< 0: nothing
  double narrowest = 0;  ///< what is narrower may have fewer
};

/// Counts the layers of triangles across channels, from the mesh alone: see docs/guarantees.md for what a crossing is.
///
/// From the middle of each edge of the boundary, and from the corners that the domain surrounds in directions less than
/// 15 degrees apart, a disk grows into the domain until it touches the boundary a second time. If its radii to the two
/// points of contact are 125 degrees apart or more, and the points are on segments without a common end, the chord
/// between them is a crossing, and the diameter is the width there. Its layers are the edges of the shortest way from
/// bank to bank along edges of the triangles
/// that the chord passes, other than those of the boundary. Crossings with fewer layers than asked for are
/// flaws.
///
/// Segments end at the vertices for which is_corner(v) holds, or, if it is empty, where the boundary bends by more than
/// a millionth. Every index of `mesh` is valid.
[[nodiscard]] AcrossReport check_across(const Mesh& mesh, const std::function<bool(std::int32_t)>& is_corner,
                                        const AcrossRule& rule, Findings& findings);

}  // namespace driftmesh
