#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "driftmesh/pslg.hpp"
#include "job/request.hpp"

namespace driftmesh::oracles {

/// The outcome for an input.
struct MeshingOutcome {
  std::string failure;   ///< the problem of the mesh, or empty
  std::string refusal;   ///< the message of the Error, if the input was rejected
  bool complete = true;  ///< false: the cap on triangles was reached
  std::size_t triangles = 0;
  std::size_t exceptions = 0;  ///< angles below the bound, allowed
};

/// Makes a mesh of the input and verifies it against the repaired input. An Error is a valid outcome; a wrong mesh is a
/// failure. Bounds are checked unless the cap was reached.
[[nodiscard]] MeshingOutcome repair_mesh_and_verify(Pslg input, const job::Request& request);

/// An input and a request.
struct MeshingCase {
  Pslg input;
  job::Request request;
  bool coarse = false;  ///< no features are smaller than those of whole grid points and crossings between them
};

/// A small input from arbitrary bytes: few points on a coarse grid, so that they often coincide, line up or are
/// cocircular, some moved by units in the last place; segments, holes, regions and bounds follow from the bytes.
[[nodiscard]] MeshingCase case_from_bytes(std::span<const std::uint8_t> bytes);

/// The input as .poly text, to be pasted into a file.
[[nodiscard]] std::string poly_text(const Pslg& input);

}  // namespace driftmesh::oracles
