#pragma once

#include <string>

#include "app/mesh_options.hpp"

namespace driftmesh::app {

/// `driftmesh mesh` in many subdomains, on the ranks that mpirun has started or on this one alone: rank 0 reads the
/// input and cuts it up, all refine, and what it came to is written and reported. `command` repeats the run. Returns
/// the exit code. What rank 0 throws before the work begins ends all ranks in good order; later errors of any rank
/// stop all of them with one message.
int mesh_in_parts(const MeshOptions& options, const std::string& command);

}  // namespace driftmesh::app
