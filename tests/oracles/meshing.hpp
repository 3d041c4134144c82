#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "driftmesh/pslg.hpp"
#include "mesh/mesher.hpp"

namespace driftmesh::oracles {

/// What became of an input.
struct MeshingOutcome {
  std::string failure;   ///< what is wrong with the mesh, empty if nothing
  std::string refusal;   ///< the message of the Error that the input was answered with, if it was
  bool complete = true;  ///< false: the cap on triangles was reached
  std::size_t triangles = 0;
  std::size_t exceptions = 0;  ///< angles below the bound, allowed
};

/// Repairs the input, meshes it and verifies the mesh against it. An Error is an answer; a mesh that is wrong is a
/// failure. Bounds are checked unless the cap was reached.
[[nodiscard]] MeshingOutcome repair_mesh_and_verify(Pslg input, const MeshRequest& request);

/// An input and a request.
struct MeshingCase {
  Pslg input;
  MeshRequest request;
  bool coarse = false;  ///< features are no smaller than whole grid points and crossings between them make them
};

/// A small input from arbitrary bytes: few points on a coarse grid, so that they coincide, line up and are cocircular
/// all the time, some moved by units in the last place; segments, holes, regions and bounds as the bytes say.
[[nodiscard]] MeshingCase case_from_bytes(std::span<const std::uint8_t> bytes);

/// The input as the text of a .poly, to be pasted into a file.
[[nodiscard]] std::string poly_text(const Pslg& input);

}  // namespace driftmesh::oracles
