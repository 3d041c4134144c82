#pragma once

#include <string>

#include "base/file_registry.hpp"
#include "job/key.hpp"
#include "job/request.hpp"

namespace driftmesh::job {

/// What a user of this door calls the key: "--size-mesh", "INPUT", or "sizing.background" in the file of an experiment.
[[nodiscard]] std::string called(const std::string& key, Door door);

/// Registers every file that making the mesh of a request reads: the domain, the background mesh and the decomposition,
/// with the files beside them that are read along. Throws InputError (see FileRegistry).
void register_reads(const Request& request, Door door, FileRegistry& files);

}  // namespace driftmesh::job
