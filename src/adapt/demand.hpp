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
  double changes = 0;      ///< how many triangles come or go to make the mesh what they ask for
};

/// `lengths`: at the vertices; empty: none are asked for. Linear between them, or as `between` says where it is not
/// null. bounds.size is of no interest. `made_for`: lengths by which the vertices were made; null: unknown.
[[nodiscard]] Demand demand_of(const Triangulation& mesh, const QualityBounds& bounds, const Lengths& lengths,
                               const SizeField* between = nullptr, const Lengths* made_for = nullptr);

}  // namespace driftmesh::adapt
