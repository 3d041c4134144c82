#pragma once

#include <cstddef>
#include <vector>

#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// Marks the segments that hang freely: those with an end that no other segment has, those to which removing these does
/// the same, and so on. Segments that may not go stay, and hold what they meet. `may_go`: one for each segment.
/// Segments without length are neither marked nor counted.
[[nodiscard]] std::vector<bool> free_branches(const std::vector<Pslg::Segment>& segments, std::size_t points,
                                              const std::vector<bool>& may_go);

}  // namespace driftmesh
