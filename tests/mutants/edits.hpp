#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mutants/corpus.hpp"

namespace driftmesh::mutants {

/// Files after a few random edits.
struct Mutant {
  Files files;
  std::vector<std::string> edits;  ///< in words
};

/// The sample that a seed edits.
[[nodiscard]] inline const Sample& sample_of(const std::vector<Sample>& corpus, std::uint64_t seed) {
  return corpus[seed % corpus.size()];
}

/// Edits that sample's files one to three times, as the seed says: fields of its formats (by other numbers, other
/// fields, or none), lines, counts together with lines, bytes and blocks of bytes, and whole files, also by those of
/// other samples.
[[nodiscard]] Mutant mutant_of(const std::vector<Sample>& corpus, std::uint64_t seed);

}  // namespace driftmesh::mutants
