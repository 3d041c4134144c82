#pragma once

#include <cstdint>

#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "runtime/plan_run.hpp"

namespace driftmesh::testing {

/// A plan made the way the program makes it.
inline RunPlan plan_for(const Pslg& pslg, const QualityBounds& bounds, std::int32_t ranks, std::int32_t subdomains,
                        Presplit presplit) {
  Triangulation mesh = triangulate(pslg);
  prepare_corners(mesh);
  DecomposeOptions cutting;
  cutting.subdomains = subdomains;
  cutting.bounds = bounds;
  PlanOptions options;
  options.mapping.ranks = ranks;
  options.presplit = presplit;
  return plan_run(decompose_for(mesh, cutting, ranks), bounds, options);
}

}  // namespace driftmesh::testing
