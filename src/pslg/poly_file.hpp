#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "driftmesh/files.hpp"
#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// read_poly of a text; `file` is for messages and for finding the .node file.
[[nodiscard]] Pslg parse_poly(const std::string& file, std::string_view text);

class RecordScanner;

/// The holes and regions at the end of a .poly, and that end.
void scan_seeds(RecordScanner& scanner, Pslg& pslg);

/// Whether a .poly leaves its vertices to the .node beside it. Throws FileError, InputError.
[[nodiscard]] bool leaves_vertices_out(const std::string& path);

/// The files that read_poly reads, or may read: `path`, and the .node beside it if there is one.
[[nodiscard]] std::vector<std::string> poly_files(const std::string& path);

}  // namespace driftmesh
