#pragma once

#include <string>
#include <vector>

#include "mesh/cdt.hpp"
#include "mesh/domain_warnings.hpp"

namespace driftmesh::testing {

/// The warnings about an input, which is repaired first.
inline std::vector<std::string> warnings_of(Pslg pslg) {
  const RepairReport repairs = repair(pslg);
  CarveReport report;
  const Triangulation mesh = triangulate(pslg, &report);
  return domain_warnings(pslg, repairs, report, mesh);
}

}  // namespace driftmesh::testing
