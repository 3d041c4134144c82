#pragma once

#include <map>
#include <vector>

#include "decompose/decomposition.hpp"
#include "dyadic/path.hpp"
#include "mesh/bounds.hpp"

namespace driftmesh {

/// Subsegments of an interface at most this many times the square root of the area bound are never split for a
/// triangle's size: a triangle above its bound has a circumradius above 0.877 sqrt(bound), and a point at that distance
/// from all others is in the diametral lens of a segment only if it is longer than 2 / 3^(1/4) = 1.51967..., the edge
/// of the equilateral triangle of area 1. Less by a margin for rounding.
inline constexpr double kPresplitSpacing = 1.5196;

/// The split points that a root gets before refinement starts, each after its ancestors, so that its subsegments are at
/// most kPresplitSpacing times the square root of the area bound there: of the smaller bound of its two sides, and of
/// the size field at the ends and the middle of each subsegment. They depend only on the root and the bounds, so both
/// sides get the same points without communication if their size fields agree to the last bit. Empty for roots that are
/// no interfaces, and if there are no bounds on size.
///
/// With a uniform area bound, refinement then splits interfaces only where features or small angles ask for more; after
/// Linardakis and Chrisochoides (2006), who decouple subdomains by discretizing interfaces beforehand.
[[nodiscard]] std::vector<dyadic::Path> presplit_paths(const Decomposition& decomposition, GlobalRootId root,
                                                       const QualityBounds& bounds);

/// Those of all interfaces that have some.
using PresplitPaths = std::map<GlobalRootId, std::vector<dyadic::Path>>;

}  // namespace driftmesh
