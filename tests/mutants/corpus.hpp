#pragma once

#include <string>
#include <vector>

#include "driftmesh/pslg.hpp"
#include "mutants/fields.hpp"

namespace driftmesh::mutants {

/// What a file is read as.
enum class Reading { kDomain, kMesh, kLengths, kAreas, kDecomposition, kSettings, kExperiment };

/// Valid files that one call of a reader reads.
struct Sample {
  std::string name;
  Reading reading;
  Files files;
  std::string main;  ///< the one whose name the reader is given
};

/// Small files of every format that the program reads, in every form: those that it writes, those of tests/fuzz/corpus,
/// and others by hand. The same on every machine. `folder` is used meanwhile.
[[nodiscard]] std::vector<Sample> make_corpus(const std::string& folder);

/// The area bound for which the decompositions in the corpus were made, of varied_domain().
inline constexpr double kDecomposedArea = 0.1;

/// Writes and reads the files of a folder.
void write_files(const Files& files, const std::string& folder);
[[nodiscard]] Files files_in(const std::string& folder);

}  // namespace driftmesh::mutants
