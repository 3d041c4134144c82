#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "driftmesh/mesh.hpp"

namespace driftmesh {

/// Old numbers of points and triangles of a mesh, as `driftmesh adapt --map` lists them: what is not listed has the
/// number that it had. Counted from 0.
struct NumberMap {
  struct Entry {
    std::int64_t now = 0, before = 0;  ///< before: -1: it is new
  };
  std::vector<Entry> points, triangles;
};

/// What of an old mesh is in a new one.
struct StayedReport {
  struct Count {
    std::int64_t stayed = 0;    ///< bit for bit, triangles with their corners in the same order
    std::int64_t numbered = 0;  ///< those with the number that they had
    std::int64_t made = 0, gone = 0;
  };
  Count points, triangles;
  std::int64_t edges = 0;         ///< those of triangles that stayed, listed in both meshes
  std::int64_t near_changes = 0;  ///< points that stayed, with other data than before, at triangles that did not
  std::vector<std::string> data;  ///< names of point data that both have
  std::vector<std::string> only_in_old, only_in_new;

  std::int64_t contradictions = 0;
  std::vector<std::string> examples;  ///< the first of them, in words
};

/// Compares two meshes from what they hold alone. With a map, each entry is checked: points have the bits, and
/// triangles the corners, of their old numbers, which are in use once; what is new is not there in the old mesh.
/// Without one, points are the same if they are at the same place. Contradictions are, besides, other markers, regions
/// or data where all triangles around a point stayed, and other edges and markers along a triangle that stayed.
[[nodiscard]] StayedReport compare_stayed(const Mesh& before, const Mesh& now, const std::optional<NumberMap>& map,
                                          std::size_t most_examples);

/// In lines that end in '\n'.
[[nodiscard]] std::string stayed_text(const StayedReport& report, bool mapped);

}  // namespace driftmesh
