#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "decompose/decomposition.hpp"
#include "driftmesh/mesh.hpp"

namespace driftmesh::app {

/// The subdomains as a mesh whose regions are a few colors, no two neighbors alike; its edges are the roots.
[[nodiscard]] Mesh colored_subdomains(const Decomposition& decomposition);

/// Draws them. Throws as plot_mesh does.
void plot_decomposition(const Decomposition& decomposition, const std::string& path, const std::string& title);

/// Draws them with one color for each owner. Throws as plot_mesh does.
void plot_owners(const Decomposition& decomposition, const IdVector<SubdomainId, Rank>& owners, const std::string& path,
                 const std::string& title);

}  // namespace driftmesh::app
