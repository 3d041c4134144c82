#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "driftmesh/adaptive.hpp"
#include "driftmesh/mesh.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh::patch {

/// Triangles that are not as lengths and an angle bound want them. Each counts for the first reason that it has.
struct Unmet {
  std::vector<bool> triangles;    ///< one for each
  std::int64_t too_large = 0;     ///< for the lengths at its corners
  std::int64_t too_dense = 0;     ///< together with those around it
  std::int64_t skinny = 0;        ///< below the angle bound, which is not an angle of the outline
  std::int64_t not_delaunay = 0;  ///< together with a neighbor
};

/// `linked`: the mesh. `lengths`: wanted, one for each point, as options want them; empty: only the bounds of the
/// options count. Triangles are too dense where all together have lengths that are shorter by more than the factor
/// `threshold`.
[[nodiscard]] Unmet find_unmet(const Mesh& mesh, const Triangulation& linked, std::span<const double> lengths,
                               const AdaptiveOptions& options, double min_angle, double threshold);

}  // namespace driftmesh::patch
