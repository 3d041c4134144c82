#pragma once

#include <cstdint>
#include <vector>

#include "base/disjoint_sets.hpp"
#include "verify/domain.hpp"
#include "verify/findings.hpp"
#include "verify/frame.hpp"
#include "verify/words.hpp"

namespace driftmesh {

/// For each triangle of a frame the set of those that subsegments do not separate inside its piece.
[[nodiscard]] DisjointSets<std::int32_t> parts_of_frame(const Frame& frame);

/// Which face of the domain each part of each piece lies in.
class FacesOfParts {
 public:
  /// `faces`: those of the frame's triangles, kNone where it is not known.
  FacesOfParts(const Frame& frame, const std::vector<std::int32_t>& faces);

  /// The faces of all triangles of a piece. `piece`: kNone for a whole mesh.
  [[nodiscard]] std::vector<std::int32_t> of_triangles(std::int32_t piece, std::size_t triangles,
                                                       DisjointSets<std::int32_t>& parts) const;

 private:
  struct Entry {
    std::int32_t piece = 0;
    std::int32_t part = 0;
    std::int32_t face = 0;
    friend auto operator<=>(const Entry&, const Entry&) = default;
  };
  std::vector<Entry> entries_;  // ascending
};

/// The mesh lists the right region attribute for each triangle in a known face.
void check_regions(const NamedMesh& mesh, const Domain& domain, const std::vector<std::int32_t>& faces,
                   Findings& findings);

}  // namespace driftmesh
