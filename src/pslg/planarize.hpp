#pragma once

#include <string>

#include "driftmesh/pslg.hpp"
#include "driftmesh/repair.hpp"

namespace driftmesh {

/// The part of repair() that makes points and segments planar; indices and coordinates have been checked.
void planarize(Pslg& pslg, const std::string& file, const RepairOptions& options, RepairReport& report);

}  // namespace driftmesh
