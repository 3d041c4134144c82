#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace driftmesh {

/// What markers of segments and attributes of regions are called, where they have names: "inlet" for marker 5. They
/// change nothing about a mesh, and go from a domain to its mesh and into files that can hold them.
///
/// A name is UTF-8 of 1 to 120 bytes, without control characters, double quotes and blanks at its ends, belongs to one
/// marker or region, and is neither "domain" nor begins with "marker " or "region ", which stand for numbers in .msh.
/// Functions that mesh or write throw InputError for others.
///
/// \code
/// driftmesh::Pslg flow = driftmesh::generate("cylinder-flow");
/// flow.names.markers = {{1, "inlet"}, {2, "outlet"}, {5, "cylinder"}};
/// const driftmesh::Mesh mesh = driftmesh::mesh(flow);
/// assert(mesh.names.markers.at(5) == "cylinder");
/// driftmesh::write_mesh(mesh, "flow.msh");  // with physical groups of these names
/// \endcode
struct Names {
  std::map<std::int32_t, std::string> markers;
  std::map<double, std::string> regions;

  [[nodiscard]] bool empty() const { return markers.empty() && regions.empty(); }
  friend bool operator==(const Names&, const Names&) = default;
};

}  // namespace driftmesh
