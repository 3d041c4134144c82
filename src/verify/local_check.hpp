#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "base/disjoint_sets.hpp"
#include "mesh/mesh_piece.hpp"
#include "verify/corner_table.hpp"
#include "verify/fan.hpp"
#include "verify/findings.hpp"
#include "verify/point_index.hpp"
#include "verify/subsegments.hpp"

namespace driftmesh {

/// Array lengths and indices. False when the other checks cannot run.
[[nodiscard]] bool check_arrays(const MeshPiece& mesh, Findings& findings);

/// Used points are finite, in the range of the predicates and distinct. Adds them to `index`, which is of the mesh's
/// points; returns how many are used.
std::size_t check_points(const MeshPiece& mesh, const CornerTable& corners, PointIndex& index, Findings& findings);

/// The edges that only one triangle has, directed so that the triangle is on their left.
[[nodiscard]] std::vector<MeshPiece::Edge> boundary_edges(const MeshPiece& mesh, const CornerTable& corners);

/// No subsegment is listed twice, or is no edge of the mesh (sides are known).
void check_subsegments(const MeshPiece& mesh, const Subsegments& subsegments, Findings& findings);

/// The edges between triangles of different subdomains, which meet there as if a segment were between them.
struct Interfaces {
  std::size_t edges = 0;                                       ///< that are no subsegments
  std::size_t not_delaunay = 0;                                ///< of these: a segment is really needed
  std::size_t between_ranks = 0;                               ///< of these: the subdomains' ranks differ
  std::set<std::pair<std::int32_t, std::int32_t>> subdomains;  ///< the pairs of subdomains that meet
};

/// The checks that look at one triangle, one edge or one vertex at a time.
class LocalCheck {
 public:
  LocalCheck(const MeshPiece& mesh, const CornerTable& corners, Subsegments& subsegments, Findings& findings)
      : mesh_(mesh), corners_(corners), subsegments_(subsegments), findings_(findings) {}

  /// Every triangle is counterclockwise (exact).
  void check_orientations();
  /// Around every vertex: each edge has one triangle on a side, an edge with one triangle is a subsegment, the fan is
  /// closed or bounded by subsegments, and every other edge, but for those between subdomains, is locally Delaunay
  /// (exact). Local Delaunay everywhere makes the triangulation constrained Delaunay. Fills in the sides of the
  /// subsegments, and joins in `parts`, if given, triangles that share an edge which is no subsegment.
  void check_vertices(DisjointSets* parts, bool delaunay);

  /// After check_vertices: the edges with one triangle, directed so that it is on their left.
  [[nodiscard]] const std::vector<MeshPiece::Edge>& boundary() const { return boundary_; }
  /// After check_vertices: what lies between subdomains, if the mesh tells them.
  [[nodiscard]] const Interfaces& interfaces() const { return interfaces_; }

 private:
  void check_vertex(std::int32_t hub);
  void check_sides(std::int32_t hub);
  void check_edge(std::int32_t u, std::int32_t v, const Spoke* left, const Spoke* right);
  void check_delaunay(std::int32_t u, std::int32_t v, const Spoke& left, const Spoke& right);
  void note_interface(std::int32_t u, std::int32_t v, const Spoke& left, const Spoke& right);
  [[nodiscard]] bool is_delaunay(std::int32_t u, std::int32_t v, const Spoke& left, const Spoke& right) const;
  [[nodiscard]] bool is_interface(const Spoke& left, const Spoke& right) const {
    return !mesh_.subdomains.empty() && mesh_.subdomains[left.triangle] != mesh_.subdomains[right.triangle];
  }
  [[nodiscard]] const Point& at(std::int32_t point) const { return mesh_.points[point]; }

  const MeshPiece& mesh_;
  const CornerTable& corners_;
  Subsegments& subsegments_;
  Findings& findings_;
  Fan fan_;
  DisjointSets* parts_ = nullptr;
  bool delaunay_ = true;
  std::vector<MeshPiece::Edge> boundary_;
  Interfaces interfaces_;
};

}  // namespace driftmesh
