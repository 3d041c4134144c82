#pragma once

#include <string>
#include <string_view>

#include "decompose/decomposition.hpp"
#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// Writes a decomposition of the (repaired) input as text (docs/file-formats.md); reading it gives an equal one. The
/// file appears only when complete. Throws FileError.
void write_decomposition(const Decomposition& decomposition, const Pslg& input, const std::string& path);

/// Reads what write_decomposition wrote for this (repaired) input and checks it with check_decomposition. Throws
/// FileError when the file cannot be read, and InputError ("file:line: what; next step") if it is not a decomposition,
/// if it is broken, or if it belongs to another input: one with other points, segments, markers, holes or regions.
[[nodiscard]] Decomposition read_decomposition(const std::string& path, const Pslg& input);

/// The same from memory; `file` is for messages.
[[nodiscard]] Decomposition parse_decomposition(const std::string& file, std::string_view text, const Pslg& input);

}  // namespace driftmesh
