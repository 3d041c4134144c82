#pragma once

#include "adapt/linear_lengths.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh::adapt {

/// Lowers lengths at the vertices of a subdomain until none grows along an edge by more than `gradation` times the
/// length of the edge: to the largest ones below the given ones that do not. Since rounded addition is monotone, these
/// are the same bits in whatever order edges are looked at, also if the subdomains of a domain take turns until nothing
/// changes. Returns whether any was lowered.
bool limit_growth(const Triangulation& mesh, double gradation, Lengths& lengths);

}  // namespace driftmesh::adapt
