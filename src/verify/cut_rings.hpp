#pragma once

#include <optional>

#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// The rings of an input's polygons alone: their points, those in the same place as one; segments without duplicates;
/// polygons without corners that repeat the one before; regions. Holes, seeds and other segments are left out. Nothing
/// if coordinates are out of range or an index names no point.
[[nodiscard]] std::optional<Pslg> rings_alone(const Pslg& input);

/// Such rings, cut where they touch and cross each other and themselves, in the verifier's own way: points stay where
/// they are, and places where edges cross are rounded. Nothing if rounding makes ever new crossings.
[[nodiscard]] std::optional<Pslg> cut_rings(Pslg rings);

}  // namespace driftmesh
