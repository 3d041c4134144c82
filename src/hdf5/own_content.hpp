#pragma once

#include <string>

namespace driftmesh {

/// Throws InputError if an HDF5 file takes any of its content from elsewhere: by a link to another file, by data that
/// are stored in one, or by a virtual dataset. A file that is no HDF5 file passes. Call it before anything reads the
/// file, because the library opens whatever such a file names.
void require_own_content(const std::string& path);

}  // namespace driftmesh
