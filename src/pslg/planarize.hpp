#pragma once

#include <string>

#include "pslg/pslg.hpp"
#include "pslg/repair_report.hpp"

namespace driftmesh {

/// The part of repair() that makes points and segments planar; indices and coordinates have been checked.
void planarize(Pslg& pslg, const std::string& file, RepairReport& report);

}  // namespace driftmesh
