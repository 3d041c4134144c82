#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/disjoint_sets.hpp"
#include "driftmesh/mesh.hpp"
#include "verify/corner_table.hpp"
#include "verify/edge_check.hpp"
#include "verify/fan.hpp"
#include "verify/findings.hpp"
#include "verify/subsegments.hpp"
#include "verify/words.hpp"

namespace driftmesh {

/// Checks lengths of arrays and indices. False if the other checks cannot run.
[[nodiscard]] bool check_arrays(const NamedMesh& mesh, Findings& findings);

/// Checks that used points are finite and in the range of the predicates. Returns how many are used.
std::size_t check_coordinates(const NamedMesh& mesh, const CornerTable& corners, Findings& findings);

/// The edges of these points with only one triangle, directed so that it is on their left.
[[nodiscard]] std::vector<Mesh::Edge> boundary_edges(const Mesh& mesh, const CornerTable& corners,
                                                     std::span<const std::int32_t> hubs);

/// Checks that every subsegment is an edge of the mesh and listed once. The subsegments know their sides.
void check_subsegments(const NamedMesh& mesh, const Subsegments& subsegments, Findings& findings);

/// Checks that triangles [begin, end) are counterclockwise (exact).
void check_orientations(const NamedMesh& mesh, std::size_t begin, std::size_t end, Findings& findings);

/// The checks of all edges and triangles around some points: each edge has at most one triangle on either side, an edge
/// with one triangle is a subsegment, the fan is closed or bounded by subsegments, and every other edge meets
/// EdgeCheck. An edge is checked from its lower end. Sets the sides of the subsegments.
class FanCheck {
 public:
  FanCheck(const NamedMesh& mesh, const CornerTable& corners, Subsegments& subsegments, const DelaunayRule& delaunay,
           std::size_t max_listed)
      : names_(mesh),
        mesh_(mesh.mesh()),
        corners_(corners),
        subsegments_(subsegments),
        findings_(max_listed),
        edges_(mesh, delaunay, max_listed) {}

  /// Joins triangles in `parts`, if given, that share an edge which is not a subsegment.
  void check(std::span<const std::int32_t> hubs, DisjointSets<std::int32_t>* parts);

  [[nodiscard]] const Findings& findings() const { return findings_; }
  [[nodiscard]] const EdgeCheck& edges() const { return edges_; }
  /// The edges with one triangle, directed so that it is on their left.
  [[nodiscard]] const std::vector<Mesh::Edge>& boundary() const { return boundary_; }

 private:
  void check_hub(std::int32_t hub);
  void check_sides(std::int32_t hub);
  void check_edge(std::int32_t u, std::int32_t v, const Spoke* left, const Spoke* right);

  NamedMesh names_;
  const Mesh& mesh_;
  const CornerTable& corners_;
  Subsegments& subsegments_;
  Findings findings_;
  EdgeCheck edges_;
  Fan fan_;
  DisjointSets<std::int32_t>* parts_ = nullptr;
  std::vector<Mesh::Edge> boundary_;
};

}  // namespace driftmesh
