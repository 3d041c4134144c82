#pragma once

#include <string>

#include "decompose/decomposition.hpp"

namespace driftmesh {

/// Plots the subdomains in a few colors, different for neighbors, and the roots. Throws like plot_mesh.
void plot_decomposition(const Decomposition& decomposition, const std::string& path, const std::string& title);

}  // namespace driftmesh
