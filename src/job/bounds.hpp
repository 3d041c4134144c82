#pragma once

#include <cstdint>

#include "job/domain.hpp"
#include "job/request.hpp"
#include "mesh/bounds.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh::job {

/// The bounds that a request sets on the mesh of a domain, on so many ranks. `mesh` is its triangulation: where the
/// request names a number of triangles, the area bound is the one that gives about as many.
[[nodiscard]] QualityBounds bounds_of(const Request& request, const Domain& domain, const Triangulation& mesh,
                                      std::int32_t ranks);

}  // namespace driftmesh::job
