#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mutants/mesh_samples.hpp"

namespace driftmesh::mutants {

/// A mesh after a few random edits.
struct MeshMutant {
  Mesh mesh;
  std::vector<std::string> edits;  ///< in words; each begins with the kind of the edit and ": "
};

/// The sample that a seed edits.
[[nodiscard]] inline const MeshSample& sample_of(const std::vector<MeshSample>& samples, std::uint64_t seed) {
  return samples[seed % samples.size()];
}

/// Edits that sample's mesh one to three times, as the seed says: moves points onto others, onto edges, a little, far,
/// to single precision and to no place; doubles, turns, exchanges, splits, adds and removes triangles; flips edges;
/// opens seams; drops, doubles, turns and adds subsegments; changes markers, regions, attributes, subdomains, indices
/// and lengths of arrays; and permutes everything, which changes nothing.
[[nodiscard]] MeshMutant mutant_of(const std::vector<MeshSample>& samples, std::uint64_t seed);

/// The kinds of edits.
[[nodiscard]] std::vector<std::string> mesh_edit_kinds();

}  // namespace driftmesh::mutants
