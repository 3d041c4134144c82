#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "base/disjoint_sets.hpp"
#include "driftmesh/mesh.hpp"
#include "verify/corner_table.hpp"
#include "verify/fan.hpp"
#include "verify/findings.hpp"
#include "verify/point_index.hpp"
#include "verify/subsegments.hpp"

namespace driftmesh {

/// Checks lengths of arrays and indices. False if the other checks cannot run.
[[nodiscard]] bool check_arrays(const Mesh& mesh, Findings& findings);

/// Checks that used points are finite, in the range of the predicates and distinct. Adds them to `index`, an index of
/// the mesh's points. Returns how many are used.
std::size_t check_points(const Mesh& mesh, const CornerTable& corners, PointIndex& index, Findings& findings);

/// The edges with only one triangle, directed so that it is on their left.
[[nodiscard]] std::vector<Mesh::Edge> boundary_edges(const Mesh& mesh, const CornerTable& corners);

/// Checks that every subsegment is an edge of the mesh and listed once. The subsegments know their sides.
void check_subsegments(const Mesh& mesh, const Subsegments& subsegments, Findings& findings);

/// The edges between triangles of different subdomains, which count as constrained.
struct Interfaces {
  std::size_t edges = 0;          ///< that are no subsegments
  std::size_t not_delaunay = 0;   ///< of these: Delaunay only because they count as constrained
  std::size_t between_ranks = 0;  ///< of these: the subdomains' ranks differ
  std::set<std::pair<std::int32_t, std::int32_t>> subdomains;  ///< the pairs of subdomains that meet
};

/// The checks that look at one triangle, one edge or one vertex at a time. Parts of a mesh may be checked in several
/// threads, each by an object of its own, and put together in order.
class LocalCheck {
 public:
  LocalCheck(const Mesh& mesh, const CornerTable& corners, Subsegments& subsegments, std::size_t max_listed)
      : mesh_(mesh), corners_(corners), subsegments_(subsegments), findings_(max_listed) {}

  /// Triangles [begin, end) are counterclockwise (exact).
  void check_orientations(std::size_t begin, std::size_t end);
  /// Around vertices [begin, end): each edge has at most one triangle on either side, an edge with one triangle is a
  /// subsegment, the fan is closed or bounded by subsegments, and every other edge, except for those between
  /// subdomains, is locally Delaunay (exact), which makes the triangulation constrained Delaunay. Sets the sides of the
  /// subsegments and, if `parts` is given, joins triangles there that share an edge which is not a subsegment.
  void check_vertices(std::size_t begin, std::size_t end, DisjointSets<std::int32_t>* parts, bool delaunay);
  /// Adds what another part has found after this one.
  void append(const LocalCheck& later);

  [[nodiscard]] const Findings& findings() const { return findings_; }
  /// After check_vertices: the edges with one triangle, directed so that it is on their left.
  [[nodiscard]] const std::vector<Mesh::Edge>& boundary() const { return boundary_; }
  /// After check_vertices: the edges between subdomains, if the mesh lists them.
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

  const Mesh& mesh_;
  const CornerTable& corners_;
  Subsegments& subsegments_;
  Findings findings_;
  Fan fan_;
  DisjointSets<std::int32_t>* parts_ = nullptr;
  bool delaunay_ = true;
  std::vector<Mesh::Edge> boundary_;
  Interfaces interfaces_;
};

}  // namespace driftmesh
