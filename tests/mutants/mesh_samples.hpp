#pragma once

#include <string>
#include <vector>

#include "driftmesh/mesh.hpp"
#include "driftmesh/pslg.hpp"

namespace driftmesh::mutants {

/// A small mesh that is right, and the domain that it was made of.
struct MeshSample {
  std::string name;
  Pslg input;
  Mesh mesh;
};

/// Meshes with all that meshes can have: holes, regions, lines within, markers, attributes, subdomains; of domains that
/// touch themselves, of points alone, of one triangle, with coordinates as in UTM. The same on every machine.
[[nodiscard]] std::vector<MeshSample> make_mesh_samples();

}  // namespace driftmesh::mutants
