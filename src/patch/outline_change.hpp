#pragma once

#include <cstdint>
#include <vector>

#include "driftmesh/mesh.hpp"
#include "patch/new_outline.hpp"

namespace driftmesh::patch {

/// What a new domain changes about a mesh.
struct OutlineChange {
  OutlineMatch match;
  std::vector<bool> inside;           ///< for each triangle, whether it has to be made anew
  std::vector<std::int32_t> dropped;  ///< marked points that are on a line no longer, on a new one, or outside
  std::int64_t other_markers = 0;     ///< listed edges that keep markers which are others in the new domain
};

/// Compares the outline of a mesh, its listed edges, with a new domain. Triangles have to be made anew that touch a
/// line which is on one of both alone, and those that are not in the domain, or in another region. Lists edges on the
/// boundary and between regions that are not listed, with the markers of the domain. Points of the domain within its
/// tolerance of one on the old outline are there. Throws InputError for a domain that encloses nothing, or has no
/// regions where the mesh has, and Error for a change at a weir.
[[nodiscard]] OutlineChange compare_outlines(Mesh& mesh, NewDomain domain);

}  // namespace driftmesh::patch
