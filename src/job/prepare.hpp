#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "decompose/decomposition.hpp"
#include "job/check.hpp"
#include "job/domain.hpp"
#include "job/limits.hpp"
#include "job/request.hpp"
#include "job/triangulated.hpp"
#include "job/watch.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh::job {

/// A mesh in subdomains, ready to be refined.
struct Prepared {
  RunPlan plan;  ///< refers to the domain's size field
  std::int32_t acute_corners = 0;
  double forecast = 0;  ///< of triangles
};

/// Triangulates the domain and prepares its corners, cuts it up, and deals the subdomains to ranks with these speeds,
/// of which only the ratios count. Throws Error for what the domain and the bounds do not allow, LimitError if far more
/// triangles than `limits` are to be expected, InputError and FileError for a decomposition that is read.
[[nodiscard]] Prepared prepare(const Request& request, const Domain& domain, const Given& given, Place place,
                               const IdVector<Rank, double>& speeds, const Limits& limits, Watch& watch);

/// The domain cut as requested, on this number of ranks.
[[nodiscard]] Decomposition cut(const Request& request, const Triangulated& triangulated, std::int32_t ranks);

}  // namespace driftmesh::job
