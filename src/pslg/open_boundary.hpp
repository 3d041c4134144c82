#pragma once

#include <string>
#include <vector>

#include "driftmesh/pslg.hpp"
#include "driftmesh/repair.hpp"

namespace driftmesh {

/// The possible reasons why a planar graph bounds no area.
struct OpenBoundary {
  bool has_loop = false;                ///< some segments form a closed chain, so they enclose area
  std::vector<std::int32_t> open_ends;  ///< points that are an end of exactly one segment
};

/// `pslg` must have been repaired.
[[nodiscard]] OpenBoundary find_open_boundary(const Pslg& pslg);

/// The explanation for the error that nothing is left after carving: which chains are open and where, with the vertex
/// numbers of the user's file (`report` is that of the repair), or that all chains are closed but the holes remove
/// everything.
[[nodiscard]] std::string describe_open_boundary(const Pslg& pslg, const RepairReport& report);

}  // namespace driftmesh
