#pragma once

#include <exception>

#include "job/team.hpp"

namespace driftmesh::job {

/// If some rank has failed, throws the failure of the first such rank, with its number, on all ranks. A team of one
/// rank throws its own exception. Collective; `own` is null on ranks without a failure.
void agree_on_failure(Team& team, const std::exception_ptr& own);

}  // namespace driftmesh::job
