#pragma once

#include "adapt/linear_lengths.hpp"
#include "driftmesh/size_field.hpp"
#include "mesh/bounds.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh::adapt {

/// What lengths and other bounds ask of a subdomain, seen from the mesh that it has.
struct Demand {
  double triangles = 0;    ///< how many triangles they ask for in all, as a fraction
  bool too_large = false;  ///< whether a triangle of the mesh exceeds them
};

/// `lengths`: at the vertices; empty: none are asked for. Linear between them, or as `between` says where it is not
/// null. bounds.size is of no interest.
[[nodiscard]] Demand demand_of(const Triangulation& mesh, const QualityBounds& bounds, const Lengths& lengths,
                               const SizeField* between = nullptr);

}  // namespace driftmesh::adapt
