#pragma once

#include <cstddef>
#include <vector>

#include "driftmesh/mesh.hpp"
#include "driftmesh/pslg.hpp"

namespace driftmesh::bench {

/// Cuts a domain into about `pieces` connected parts of similar area, along the edges of a coarse mesh of it. `holes`
/// are the hole points of the domain. Each part is a domain of its own, bounded by the edges that it shares with others
/// or with the outside. A few parts are the small remainders between larger ones.
[[nodiscard]] std::vector<Pslg> cut(const Mesh& coarse, const std::vector<Point>& holes, std::size_t pieces);

}  // namespace driftmesh::bench
