#pragma once

#include "app/mesh_outputs.hpp"

namespace driftmesh::app {

/// `driftmesh mesh` on the ranks of mpirun, which all call it; returns the exit code. See run_mesh.
[[nodiscard]] int mesh_on_ranks(const Told& told);

}  // namespace driftmesh::app
