#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "driftmesh/mesh.hpp"

namespace driftmesh {

/// The contradictions between pieces: their number, and messages for the first ones.
struct MergeFaults {
  static constexpr std::size_t kMostListed = 20;
  std::size_t count = 0;
  std::vector<std::string> first;

  template <class Describe>
  void add(const Describe& describe) {
    if (count++ < kMostListed) first.push_back(describe());
  }
};

/// Which numbers the points of all pieces together should have.
enum class Numbering : std::uint8_t {
  kComplete,  ///< all from 0 on
  kSparse,    ///< any: what is merged are parts of pieces. The result lists them (Mesh::numbers)
};

/// The whole mesh from its pieces: points with the same number become one, at the place of that number; a subsegment
/// that two pieces have between the same points is taken once. Triangles are sorted by subdomain if all pieces list
/// subdomains, and subsegments by their ends, so the result (except for `ranks`) does not depend on which rank held
/// which subdomain.
///
/// Where pieces contradict each other, the first one counts and the contradiction is added to `faults`: a point with
/// different coordinates, marker or attributes in another piece; a marker or a region with different names; a number
/// twice in one piece; a number below the largest that no piece has (such a point is in no triangle; if there are many,
/// the gaps are closed). Throws Error if a piece has no numbers, or negative ones.
[[nodiscard]] Mesh merge_pieces(std::span<const Mesh* const> pieces, MergeFaults& faults,
                                Numbering numbering = Numbering::kComplete);
/// `order`, unless null: of each triangle of the whole the number among those of all pieces, one piece after the other.
[[nodiscard]] Mesh merge_pieces(std::span<const Mesh> pieces, MergeFaults& faults,
                                std::vector<std::size_t>* order = nullptr);

}  // namespace driftmesh
