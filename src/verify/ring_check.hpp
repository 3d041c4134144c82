#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/disjoint_sets.hpp"
#include "driftmesh/mesh.hpp"
#include "verify/corner_table.hpp"
#include "verify/edge_check.hpp"
#include "verify/ring.hpp"

namespace driftmesh {

/// Checks what is inside a piece: the edges around vertices whose triangles form one closed ring and that have nothing
/// to do with subsegments. All other vertices are left to FanCheck.
class RingCheck {
 public:
  /// `marks`: for each point whether it is left to FanCheck. Points whose triangles form no ring are marked, too.
  RingCheck(const NamedMesh& mesh, const CornerTable& corners, std::vector<char>& marks, const DelaunayRule& delaunay,
            std::size_t max_listed);

  /// Around points [begin, end). An edge is checked from its end with the lower number. Joins triangles in `parts`, if
  /// given, that share such an edge.
  void check(std::size_t begin, std::size_t end, DisjointSets<std::int32_t>* parts);

  [[nodiscard]] const EdgeCheck& edges() const { return edges_; }

 private:
  void check_hub(std::int32_t hub);
  [[nodiscard]] bool in_one_subdomain() const;
  template <std::size_t Most>
  [[nodiscard]] bool surely_delaunay(std::int32_t hub) const;
  void check_edge(std::int32_t hub, std::size_t i);
  [[nodiscard]] bool is_lower(std::int32_t u, std::int32_t v) const {
    return ascending_ ? u < v : names_.number(u) < names_.number(v);
  }

  NamedMesh names_;
  const Mesh& mesh_;
  const CornerTable& corners_;
  std::vector<char>& marks_;
  EdgeCheck edges_;
  bool ascending_;  // the numbers of points
  DisjointSets<std::int32_t>* parts_ = nullptr;
  Ring ring_;
};

}  // namespace driftmesh
