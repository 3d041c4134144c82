#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/file_registry.hpp"
#include "cli/command.hpp"
#include "driftmesh/files.hpp"

namespace driftmesh::app {

/// --allow-outside of the commands that read meshes.
[[nodiscard]] cli::Option allow_outside_option(ReadOptions& options);

/// --allow-code of the commands that read YAML files.
[[nodiscard]] cli::Option allow_code_option(bool& allowed);

// Commands register every file before the work starts. `use` is what the command line calls it. All throw InputError if
// the file has another use (see FileRegistry); those for outputs also FileError if writing would fail after the work,
// because a folder is missing or not writable, say.

/// A mesh, with all files that read_mesh would read.
void register_mesh_input(FileRegistry& files, const std::string& path, const std::string& use,
                         const ReadOptions& options);

/// An empty path is no file.
void register_output(FileRegistry& files, const std::string& path, const std::string& use);
/// A mesh in pieces of so many `ranks`, or a whole one if there are none. Errors: as format_of, require_whole.
void register_mesh_output(FileRegistry& files, const std::string& path, const std::string& use, std::int32_t ranks = 0);
/// An empty path is no picture. InputError for an unknown extension.
void register_picture(FileRegistry& files, const std::string& path, const std::string& use);

}  // namespace driftmesh::app
