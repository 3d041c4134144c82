#pragma once

#include <cstddef>
#include <cstdint>

#include "driftmesh/id_vector.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

/// A part of the plane without segments inside; kNone: removed, or outside the triangulation.
enum class AreaId : std::int32_t {};

/// The areas into which constrained edges divide a triangulation, in the order of their first triangles.
class Areas {
 public:
  explicit Areas(const Triangulation& mesh);

  [[nodiscard]] std::size_t count() const { return largest_.size(); }
  [[nodiscard]] IdRange<AreaId> ids() const { return ids_of(largest_); }
  [[nodiscard]] AreaId of(TriangleId t) const { return of_[t]; }
  [[nodiscard]] AreaId of(HalfEdge h) const { return h == kNone ? AreaId{kNone} : of_[triangle_of(h)]; }
  /// The largest triangle of an area.
  [[nodiscard]] TriangleId largest(AreaId area) const { return largest_[area]; }

 private:
  void flood(const Triangulation& mesh, TriangleId first, std::vector<TriangleId>& stack);

  IdVector<TriangleId, AreaId> of_;
  IdVector<AreaId, TriangleId> largest_;
};

/// A point inside a triangle: its centroid.
[[nodiscard]] Point center_of(const Triangulation& mesh, TriangleId t);

}  // namespace driftmesh
