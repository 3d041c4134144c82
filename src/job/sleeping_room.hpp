#pragma once

#include <memory>
#include <string>

#include "base/scratch_file.hpp"

namespace driftmesh::job {

/// The scratch file of a process in whose folder `triangles` in all are expected to sleep, its own and those of others;
/// null if there is no folder. Throws FileError if it cannot be written or has too little room, before the work begins.
[[nodiscard]] std::unique_ptr<ScratchFile> open_scratch(const std::string& folder, double triangles);

}  // namespace driftmesh::job
