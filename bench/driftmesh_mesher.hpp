#pragma once

#include <cstddef>
#include <vector>

#include "bench/mesher.hpp"

namespace driftmesh::bench {

/// The mesher of this project: the whole domain as one subdomain.
extern const Mesher kDriftmesh;

/// A domain of the given area cut into about `pieces` parts, along the edges of a coarse mesh of it.
[[nodiscard]] std::vector<Pslg> parts_of(const Pslg& pslg, double area, double degrees, std::size_t pieces);

/// Meshes the parts one after the other and keeps them all. Seconds and counts are totals; vertices on shared edges
/// count once for each part.
[[nodiscard]] MeshRun refine_parts(const std::vector<Pslg>& parts, const Bounds& bounds);

}  // namespace driftmesh::bench
