#pragma once

#include <string>

#include "job/key.hpp"
#include "job/request.hpp"

namespace driftmesh::app {

/// `driftmesh mesh`: makes the mesh of a request at a place of this kind, writes and plots it, and reports. `command`
/// repeats the run; `config` is the settings file that the request came from, or empty. Returns the exit code. With
/// many ranks, collective. An exception on rank 0 before the work starts ends all ranks cleanly; later errors on any
/// rank stop all of them with one message.
[[nodiscard]] int run_mesh(const job::Request& request, job::PlaceKind kind, const std::string& command,
                           const std::string& config);

}  // namespace driftmesh::app
