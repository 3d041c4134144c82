#pragma once

#include <optional>
#include <vector>

#include "driftmesh/pslg.hpp"
#include "verify/domain.hpp"
#include "verify/findings.hpp"

namespace driftmesh {

/// Whether repair did no more to an input's polygons than to make one of points in the same place.
[[nodiscard]] bool same_polygons(const Pslg& given, const Pslg& repaired);

/// Whether there are regions that no polygon names.
[[nodiscard]] bool has_seeds(const Pslg& input);

/// Checks the domain of a repaired input against the polygons as they were given, which are cut and covered anew (see
/// cut_rings, FaceCover): the area in total and of each region, as far as rounding does not explain the difference,
/// and that each face whose place is given lies in them and has their region. `places`: for each face of `domain` a
/// place that is well inside, if one is known. `moved`: by how much repair may have moved borders besides rounding; if
/// it may, areas alone are compared. False if rounding keeps the polygons from being cut.
[[nodiscard]] bool check_polygons(const Pslg& given, const Domain& domain,
                                  const std::vector<std::optional<Point>>& places, double moved, Findings& findings);

}  // namespace driftmesh
