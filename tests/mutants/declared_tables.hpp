#pragma once

#include <string>
#include <string_view>

#include "decompose/decomposition.hpp"
#include "driftmesh/mesh.hpp"
#include "driftmesh/pslg.hpp"
#include "mutants/fields.hpp"

// What files of lines with numbers declare: Triangle's formats, and decompositions. Written from docs/file-formats.md
// alone, without code of the readers, so that the two can be compared. All functions throw Undeclared.

namespace driftmesh::mutants {

/// A domain: the .poly NAME, with its vertices in the .node of the same stem if it has none, or a .node.
[[nodiscard]] Pslg declared_domain(const Files& files, const std::string& name);

/// The mesh in the .node, .ele, .poly and .edge with this stem, which ends in a dot.
[[nodiscard]] Mesh declared_triangle_mesh(const Files& files, const std::string& stem);

/// A background mesh: one length for each point, or one area bound for each triangle.
struct DeclaredBackground {
  Mesh mesh;
  std::vector<double> lengths;
  std::vector<double> areas;
};
/// Likewise in .node and .ele, and in .area if asked for.
[[nodiscard]] DeclaredBackground declared_background(const Files& files, const std::string& stem, bool with_areas);

/// The points, roots, subdomains and inner points of a decomposition. Its digest of the input is not looked at.
[[nodiscard]] Decomposition declared_decomposition(std::string_view text);

}  // namespace driftmesh::mutants
