#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "driftmesh/pslg.hpp"
#include "driftmesh/size_field.hpp"
#include "geometry/box_tree.hpp"
#include "triangle/tables.hpp"

namespace driftmesh::triangle {

/// A mesh that is to be refined: the domain that it covers, and what is known of each of its triangles.
class OldMesh {
 public:
  /// The tables must outlive it. Throws InputError if there are no triangles, or corners that are no points.
  explicit OldMesh(const Tables& tables);

  /// Its points in triangles, and its boundary as polygons with segments of their own. `segments`: whether the
  /// segments of the tables count as well.
  [[nodiscard]] Pslg domain(bool segments) const;

  /// A triangle that contains `p`, on its border or inside; -1 if there is none.
  [[nodiscard]] std::int32_t triangle_at(const Point& p) const;
  /// Calls visit(t) for all triangles that contain `p`.
  template <class Visit>
  void visit_at(const Point& p, const Visit& visit) const {
    tree_.visit_containing(p, [&](std::int32_t t) {
      if (contains(t, p)) visit(t);
    });
  }

 private:
  using Corners = std::array<std::int32_t, 3>;
  [[nodiscard]] bool contains(std::int32_t t, const Point& p) const;
  [[nodiscard]] std::vector<Pslg::Polygon> outline() const;

  const Tables& tables_;
  std::vector<Corners> triangles_;  // counterclockwise
  BoxTree tree_;
};

/// Edge lengths that keep triangles within the area bounds of the triangles of a mesh in which their centroids lie.
class AreaField final : public SizeField {
 public:
  /// `areas`: one for each triangle of the mesh, which must outlive this; <= 0: no bound.
  AreaField(const OldMesh& mesh, std::span<const double> areas);
  /// That of the triangle around p; on borders, the largest that applies, since the centroid is asked as well.
  [[nodiscard]] double edge_length(const Point& p) const override;

 private:
  const OldMesh& mesh_;
  std::vector<double> length_;  // what each triangle asks for
};

}  // namespace driftmesh::triangle
