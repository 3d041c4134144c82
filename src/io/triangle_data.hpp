#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace driftmesh {

/// Values at the triangles of a mesh by their names, one for each triangle: what files have of them besides what Mesh
/// has a place for.
using TriangleData = std::map<std::string, std::vector<double>>;

/// Whether files have something of this name among the values of cells, so that no data can have it.
[[nodiscard]] inline bool is_array_on_cells(std::string_view name) {
  return name == "marker" || name == "region" || name == "subdomain" || name == "rank" || name == "vtkGhostType";
}

/// What data are called of which this is component k of so many.
[[nodiscard]] inline std::string name_of_component(const std::string& name, std::size_t components, std::size_t k) {
  return components == 1 ? name : name + "_" + std::to_string(k);
}

}  // namespace driftmesh
