#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/disjoint_sets.hpp"
#include "driftmesh/mesh.hpp"
#include "verify/chains.hpp"
#include "verify/domain.hpp"
#include "verify/findings.hpp"
#include "verify/point_index.hpp"
#include "verify/subsegments.hpp"
#include "verify/words.hpp"

namespace driftmesh {

/// Checks that the boundary of the mesh, directed with a triangle on the left of each edge, meets itself at points
/// only, and winds once around some faces of its arrangement and not at all around the others. If all triangles are
/// counterclockwise, this proves that no point is covered twice.
void check_embedding(const NamedMesh& mesh, const std::vector<Mesh::Edge>& boundary, Findings& findings);

/// The checks of a mesh against the domain that its input describes.
class DomainCheck {
 public:
  DomainCheck(const NamedMesh& mesh, const Domain& domain, const PointIndex& mesh_points, const Chains& chains,
              Findings& findings);

  /// Every point of the domain's input is a vertex.
  void check_points();
  /// Chains of subsegments correspond to the domain's segments; see verify.
  void check_chains();
  void check_area(double mesh_area);
  /// `triangles`: how many there are, also outside of this part of the mesh.
  void check_euler(std::int64_t triangles, std::int64_t used_points, std::int64_t boundary_edges);

  /// The face of the domain that each triangle lies in, kNone if it is not known. `parts` has joined triangles that
  /// share an edge which is no subsegment.
  [[nodiscard]] std::vector<std::int32_t> find_faces(DisjointSets<std::int32_t>& parts) const;
  /// For each face of the domain the centroid of the thickest triangle that lies in it along a segment, if one is so
  /// thick that rounding cannot move it out of the face.
  [[nodiscard]] std::vector<std::optional<Point>> find_places() const;
  /// For each point of a mesh whether it is one of the domain's points.
  [[nodiscard]] static std::vector<char> find_corners(const Mesh& mesh, const Domain& domain,
                                                      const PointIndex& mesh_points);

 private:
  void check_chain(const Chains::Chain& chain, const Domain::Segment& segment, bool reversed);
  void check_straight(const Chains::Chain& chain);
  void check_side(std::int32_t subsegment, std::int32_t triangle, std::int32_t face);
  template <class Visit>
  void for_each_side(const Visit& visit) const;
  [[nodiscard]] long double thickness(std::int32_t triangle) const;
  [[nodiscard]] std::string chain_words(const Chains::Chain& chain) const;

  NamedMesh names_;
  const Mesh& mesh_;
  const Domain& domain_;
  const Chains& chains_;
  Findings& findings_;
  std::vector<std::int32_t> vertex_of_point_;   // vertices of the domain; kNone if missing
  std::vector<std::int32_t> segment_of_chain_;  // kNone: the chain belongs to no segment
};

}  // namespace driftmesh
