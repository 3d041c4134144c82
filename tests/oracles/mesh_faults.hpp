#pragma once

#include <string>

#include "driftmesh/mesh.hpp"
#include "driftmesh/pslg.hpp"

// Whether a small mesh is right, from definitions: every pair of triangles, of boundary edges, of subsegments and input
// segments is compared, in exact arithmetic.

namespace driftmesh::oracles {

struct Fault {
  std::string what;        ///< the first fault in words, "" if there is none
  bool certain = true;     ///< false: rounding decides, so that either answer is right
  bool in_arrays = false;  ///< lengths of arrays or indices are wrong: such a mesh cannot be written to a file
};

/// The first fault of a mesh by itself: in its arrays; points in the same place; triangles that are not
/// counterclockwise or have inner points in common; edges with two triangles on a side, or with one triangle that are
/// not listed; subsegments that are no edges or are listed twice; boundary edges that meet elsewhere than at a common
/// end; edges between triangles of one subdomain that are neither subsegments nor Delaunay.
[[nodiscard]] Fault fault_of(const Mesh& mesh);

/// The same, and the first difference from a mesh of `input` that is known to be right: another part of the plane,
/// other regions, input points that are no vertices or have other markers or attributes, input segments that are not a
/// chain of subsegments with their marker, subsegments elsewhere.
[[nodiscard]] Fault fault_of(const Mesh& mesh, const Pslg& input, const Mesh& right);

}  // namespace driftmesh::oracles
