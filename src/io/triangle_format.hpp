#pragma once

#include <string>
#include <vector>

#include "driftmesh/mesh.hpp"

namespace driftmesh {

/// Writes STEM.node, .ele, .poly, .edge and .neigh as Triangle defines them, numbered from 1. They appear together, or
/// not at all. Separators, on which subdomains meet, are segments and edges with kSeparatorMarker
/// (pslg/triangle_files.hpp), which no constrained edge may have: InputError.
void write_triangle_format(const Mesh& mesh, const std::string& stem, const std::vector<Point>& holes);

/// Reads STEM.node and STEM.ele. The constrained edges are the segments of STEM.poly if that file exists and takes
/// its vertices from the .node file; otherwise the edges of STEM.edge whose marker is not 0, if that file exists. The
/// last attribute of a triangle is its region. If there are separators, the subdomains are the parts between separators
/// and constrained edges, numbered anew. STEM.poly without STEM.ele is an InputError: it is a domain.
[[nodiscard]] Mesh read_triangle_format(const std::string& stem);

}  // namespace driftmesh
