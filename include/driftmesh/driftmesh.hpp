#pragma once

// Everything that a program without MPI needs. With it: driftmesh/mpi/distributed.hpp.
#include "driftmesh/check.hpp"
#include "driftmesh/decomposition.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/files.hpp"
#include "driftmesh/generate.hpp"
#include "driftmesh/mesh.hpp"
#include "driftmesh/mesher.hpp"
#include "driftmesh/options.hpp"
#include "driftmesh/point.hpp"
#include "driftmesh/policy.hpp"
#include "driftmesh/pslg.hpp"
#include "driftmesh/repair.hpp"
#include "driftmesh/simplify.hpp"
#include "driftmesh/size_field.hpp"
#include "driftmesh/size_on_mesh.hpp"
#include "driftmesh/version.hpp"
