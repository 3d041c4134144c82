#pragma once

#include <string>

#include "base/file_registry.hpp"
#include "job/key.hpp"
#include "job/request.hpp"

namespace driftmesh::job {

/// What a user of this entry point calls the key: "--size-mesh", "INPUT", or "sizing.background" in the file of an
/// experiment. On the command line any other name is that of an option.
[[nodiscard]] std::string called(const std::string& key, EntryPoint entry_point);

/// The same for messages.
[[nodiscard]] Words words_of(EntryPoint entry_point);

/// Registers every file that making the mesh of a request reads: the domain, the background mesh and the decomposition,
/// with the files beside them that are read along. Throws InputError (see FileRegistry).
void register_reads(const Request& request, EntryPoint entry_point, FileRegistry& files);

}  // namespace driftmesh::job
