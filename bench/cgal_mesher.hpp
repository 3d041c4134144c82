#pragma once

#include "bench/mesher.hpp"

namespace driftmesh::bench {

/// CGAL's constrained Delaunay triangulation and Delaunay_mesher_2, with exact predicates and inexact constructions.
extern const Mesher kCgal;

/// The area of the domain that `pslg` bounds: what its outer boundary encloses, less its holes.
[[nodiscard]] double domain_area(const Pslg& pslg);

}  // namespace driftmesh::bench
