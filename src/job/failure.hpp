#pragma once

#include <exception>

#include "job/team.hpp"

namespace driftmesh::job {

/// Throws on all ranks alike if one of them has failed: what the first of these met, with its number. A rank that is
/// alone throws its own exception. All ranks together; `own` is null where nothing has failed.
void agree_on_failure(Team& team, const std::exception_ptr& own);

}  // namespace driftmesh::job
