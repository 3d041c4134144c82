#pragma once

/// \file
/// Everything that a program without MPI needs. With it: driftmesh/mpi/distributed.hpp.
/// \code
/// const driftmesh::Pslg bay = driftmesh::generate("bay");  // or driftmesh::read_input("your.poly").pslg
/// const driftmesh::Mesh mesh = driftmesh::mesh(bay, {.min_angle = 25, .triangles = 50e3});
/// driftmesh::write_mesh(mesh, "bay.vtu");
/// \endcode

#include "driftmesh/adapt_part.hpp"
#include "driftmesh/adaptive.hpp"
#include "driftmesh/check.hpp"
#include "driftmesh/close_channels.hpp"
#include "driftmesh/decomposition.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/files.hpp"
#include "driftmesh/generate.hpp"
#include "driftmesh/mesh.hpp"
#include "driftmesh/mesh_order.hpp"
#include "driftmesh/mesher.hpp"
#include "driftmesh/names.hpp"
#include "driftmesh/options.hpp"
#include "driftmesh/outline.hpp"
#include "driftmesh/point.hpp"
#include "driftmesh/policy.hpp"
#include "driftmesh/pslg.hpp"
#include "driftmesh/repair.hpp"
#include "driftmesh/simplify.hpp"
#include "driftmesh/size_field.hpp"
#include "driftmesh/size_on_mesh.hpp"
#include "driftmesh/size_rule.hpp"
#include "driftmesh/version.hpp"
