#pragma once

#include <cstdint>
#include <string>

#include "mutants/mesh_samples.hpp"

namespace driftmesh::mutants {

/// What the checks say of a mesh, and what is true.
struct MeshVerdict {
  bool accepted = false;  ///< as a mesh of its input
  std::string fault;      ///< what is wrong with it by the oracle, or ""
  std::string failure;    ///< the check that says something else, or ""
};

/// Checks a mesh in every way there is: by itself and against the input of its sample; in one piece and in several, of
/// which the seed tells how they are cut; by the library; and, for one seed in eight, read back from a file in the
/// folder. Each must accept it if tests/oracles/mesh_faults.hpp finds no fault, and reject it otherwise.
[[nodiscard]] MeshVerdict judge(const MeshSample& sample, const Mesh& mesh, std::uint64_t seed,
                                const std::string& folder);

}  // namespace driftmesh::mutants
