#pragma once

#include <string>
#include <string_view>

#include "pslg/pslg.hpp"

namespace driftmesh {

/// Reads Triangle's .poly: vertices with attributes and boundary markers, segments, holes, and regions with
/// an attribute and an area bound. A region with one value uses it for both, as Triangle does: the caller's
/// options decide which of the two counts. A .poly with 0 vertices takes them from the .node file of the same
/// stem. A path that ends in .node is read as points alone. Geometric faults (duplicates, crossings)
/// are left for repair(). Throws FileError when a file cannot be read and InputError with up to
/// ten messages "file:line: what; next step".
[[nodiscard]] Pslg read_poly(const std::string& path);

/// The same from memory; `file` is for messages and for finding the .node file.
[[nodiscard]] Pslg parse_poly(const std::string& file, std::string_view text);

/// Writes `pslg` as .poly, numbered from pslg.first_number. Numbers are the shortest that read back to the
/// same bits; reading the file gives an equal Pslg. The file appears only once it is complete. Throws FileError.
void write_poly(const Pslg& pslg, const std::string& path);

}  // namespace driftmesh
