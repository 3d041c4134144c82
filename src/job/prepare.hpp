#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "decompose/decomposition.hpp"
#include "job/check.hpp"
#include "job/domain.hpp"
#include "job/request.hpp"
#include "job/triangulated.hpp"
#include "job/watch.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh::job {

/// A mesh in subdomains, ready to be refined.
struct Prepared {
  RunPlan plan;  ///< refers to the domain's size field
  std::int32_t acute_corners = 0;
  double forecast = 0;  ///< triangles after refinement
};

/// Decomposes the domain, triangulated, and maps the subdomains to ranks with these speeds, of which only the ratios
/// matter. Throws Error if domain and bounds do not allow that, InputError and FileError if a decomposition cannot be
/// read.
[[nodiscard]] Prepared prepare(const Request& request, const Domain& domain, const Triangulated& triangulated,
                               const Given& given, PlaceKind place, const IdVector<Rank, double>& speeds, Watch& watch);

/// Gives a plan that was made before what the request says of work and balancing, at this place.
void plan_anew(RunPlan& plan, const Request& request, PlaceKind place, const IdVector<Rank, double>& speeds);

/// Decomposes the domain as requested, for this number of ranks.
[[nodiscard]] Decomposition cut(const Request& request, const Triangulated& triangulated, std::int32_t ranks);

}  // namespace driftmesh::job
