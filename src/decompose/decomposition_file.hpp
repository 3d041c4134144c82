#pragma once

#include <string>
#include <string_view>

#include "decompose/decomposition.hpp"
#include "pslg/pslg.hpp"

namespace driftmesh {

/// Writes a decomposition as text (docs/file-formats.md); reading it gives an equal one. The file appears when it is
/// complete. Throws FileError.
void write_decomposition(const Decomposition& decomposition, const std::string& path);

/// Reads what write_decomposition wrote and checks it with check_decomposition. Throws FileError when the file cannot
/// be read, and InputError ("file:line: what; next step") for what is not a decomposition or a broken one.
[[nodiscard]] Decomposition read_decomposition(const std::string& path);

/// The same from memory; `file` is for messages.
[[nodiscard]] Decomposition parse_decomposition(const std::string& file, std::string_view text);

/// Throws InputError, naming `file`, unless the decomposition was made from this (repaired) input: its input points are
/// those of `pslg`.
void require_same_input(const Decomposition& decomposition, const Pslg& pslg, const std::string& file);

}  // namespace driftmesh
