#pragma once

#include <string>

#include "job/key.hpp"
#include "job/request.hpp"

namespace driftmesh::app {

/// `driftmesh mesh`: makes the mesh that a (checked) request asks for at this place, writes and draws it, and reports.
/// `command` repeats the run. Returns the exit code.
///
/// On many ranks, all processes call it. What rank 0 throws before the work begins ends all ranks in good order; later
/// errors of any rank stop all of them with one message.
[[nodiscard]] int run_mesh(const job::Request& request, job::Place place, const std::string& command);

}  // namespace driftmesh::app
