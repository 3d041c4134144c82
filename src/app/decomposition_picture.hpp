#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "decompose/decomposition.hpp"
#include "driftmesh/mesh.hpp"

namespace driftmesh::app {

/// The subdomains as a mesh whose regions are a few colors, different for neighbors; its edges are the roots.
[[nodiscard]] Mesh colored_subdomains(const Decomposition& decomposition);

/// Plots them. Throws like plot_mesh.
void plot_decomposition(const Decomposition& decomposition, const std::string& path, const std::string& title);

}  // namespace driftmesh::app
