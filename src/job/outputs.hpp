#pragma once

#include "base/staged_files.hpp"
#include "job/team.hpp"

namespace driftmesh::job {

/// What each rank has staged appears under its names, on all ranks or on none: the files of rank 0, such as the .pvtu
/// that names pieces, after those of the others. All ranks together. If a rank cannot rename a file, all throw the
/// same, and the files under these names are as they were.
void commit(Team& team, StagedFiles& files);

/// The files that all ranks have staged, on rank 0; its own elsewhere. All ranks together.
[[nodiscard]] std::vector<StagedFiles::Listed> staged_by_all(Team& team, const StagedFiles& files);

}  // namespace driftmesh::job
