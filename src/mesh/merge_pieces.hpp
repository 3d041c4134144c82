#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "mesh/mesh_piece.hpp"

namespace driftmesh {

/// The ways in which pieces contradict each other: how many, and the first ones in words.
struct MergeFaults {
  static constexpr std::size_t kMostListed = 20;
  std::size_t count = 0;
  std::vector<std::string> first;

  template <class Describe>
  void add(const Describe& describe) {
    if (count++ < kMostListed) first.push_back(describe());
  }
};

/// The whole mesh from its pieces: points with the same number become one, at the place of that number; a subsegment
/// that two pieces have between the same points is taken once. Triangles come sorted by subdomain if all pieces tell
/// them, subsegments by their ends, so the result does not depend on who had which subdomain (but for `ranks`).
///
/// Where pieces contradict each other the first one holds, and `faults` says so: a point with other coordinates, marker
/// or attributes in another piece, a number twice in one piece, numbers below the largest that no piece has (such a
/// point is in no triangle; where they are many, points move up into the gaps). Throws Error if a piece has no numbers,
/// or negative ones.
[[nodiscard]] MeshPiece merge_pieces(std::span<const MeshPiece> pieces, MergeFaults& faults);

}  // namespace driftmesh
