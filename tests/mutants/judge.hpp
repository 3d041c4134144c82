#pragma once

#include <string>

#include "mutants/corpus.hpp"

namespace driftmesh::mutants {

/// What came of reading files.
struct Verdict {
  bool accepted = false;
  bool declared = false;  ///< whether the files declare something; of settings, whether they were accepted
  std::string message;    ///< text of the refusal, or why nothing is declared
  std::string failure;    ///< what must not happen, or ""
};

/// Reads the files, which are in the folder, as the program does, and compares the outcome with what they declare:
/// - A refusal is a driftmesh::Error whose message names a file and can be shown on a terminal.
/// - What is accepted is what a second reader finds: a domain or a mesh with all its arrays in the same order; a
///   background mesh with its triangles and the lengths in them; a decomposition with all its records, which also
///   meshes to a mesh of its domain; the value of every key (see settings_check.hpp).
[[nodiscard]] Verdict judge(const Sample& sample, const Files& files, const std::string& folder);

}  // namespace driftmesh::mutants
