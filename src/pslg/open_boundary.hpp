#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// The possible reasons why a planar graph bounds no area.
struct OpenBoundary {
  bool has_loop = false;                ///< some segments form a closed chain, so they enclose area
  std::vector<std::int32_t> open_ends;  ///< points that are an end of exactly one segment
};

/// `pslg` must have been repaired.
[[nodiscard]] OpenBoundary find_open_boundary(const Pslg& pslg);

/// Where a boundary is most likely meant to be closed.
struct Gap {
  std::int32_t a, b;  ///< indices of points
  double width;       ///< their distance
};

/// The nearest two of these open ends that no segment joins; empty if there are none.
[[nodiscard]] std::optional<Gap> find_gap(const Pslg& pslg, const std::vector<std::int32_t>& open_ends);

/// What of a chain of segments has these open ends: which two are nearest, how far they are apart, and what to do.
/// Empty if there is no gap.
[[nodiscard]] std::string describe_gap(const Pslg& pslg, const std::vector<std::int32_t>& open_ends);

/// Why a planar graph encloses no area, and what to do: where its boundary is open, and how wide the gap is.
[[nodiscard]] std::string describe_open_boundary(const Pslg& pslg);

}  // namespace driftmesh
