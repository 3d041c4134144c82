#pragma once

#include <vector>

#include "verify/arrangement.hpp"

namespace driftmesh {

/// 1 for each face that an odd number of rings encloses: what is left where rings alternate between holes and islands.
///
/// Two links belong to one ring if a closed way that visits no point twice takes both; so rings that touch at a point
/// are two, and rings that share links are one. In a planar graph these are the same sets of links as those that closed
/// ways from face to face take (Whitney 1932). So a search of the faces in depth finds rings (Hopcroft and Tarjan
/// 1973), and each with the face around it. A set of links with an even number at each of its points counts as several
/// rings that touch or cross: each link leads to one more of them, or one less.
[[nodiscard]] std::vector<char> inside_of_alternating_rings(const Arrangement& arrangement);

}  // namespace driftmesh
