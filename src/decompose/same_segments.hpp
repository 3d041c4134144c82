#pragma once

#include <string>

#include "decompose/decomposition.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

/// Throws InputError, naming `file`, unless a decomposition is one of this domain, which is triangulated, with its
/// corners prepared, and not refined. Roots that are no separators make up exactly the domain's root segments: the same
/// ends, marker, sides and regions; ends of separators between them on the line, or, on a shell piece, at its
/// midpoints, with names that tell shells and circles apart as the domain's do. Every point of the domain is there, and
/// those on no root lie in their subdomain. The decomposition passes check_decomposition and require_same_input.
void require_same_segments(const Decomposition& decomposition, const Triangulation& domain, const std::string& file);

}  // namespace driftmesh
