#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "driftmesh/id_vector.hpp"

namespace driftmesh {

/// What can be wrong with a mesh. Each kind is counted on its own.
enum class Flaw : std::uint8_t {
  // The arrays of the piece.
  bad_array,        ///< an array has the wrong length
  bad_index,        ///< a triangle or subsegment names a point that does not exist, or the same point twice
  bad_coordinate,   ///< a used point is not finite or outside the range of the exact predicates
  duplicate_point,  ///< two used points have the same coordinates
  pieces_disagree,  ///< a point differs between pieces in coordinates, marker or attributes, or a number is missing
  // The triangulation.
  not_counterclockwise,  ///< a triangle is inverted or flat (exact)
  duplicate_triangle,    ///< two triangles have the same corners
  edge_used_twice,       ///< two triangles lie on the same side of an edge
  open_edge,             ///< an edge with one triangle is not a subsegment: a triangle is missing, or a T-junction
  tangled_vertex,        ///< the triangles around a vertex form neither one closed fan nor only open ones
  stray_subsegment,      ///< a subsegment is not an edge of the mesh
  duplicate_subsegment,  ///< a subsegment is listed twice
  boundary_crosses,      ///< two subsegments of the boundary cross, overlap or touch other than at a common end
  overlap,               ///< a part of the plane is covered by more than one triangle
  not_delaunay,          ///< the point opposite an unconstrained edge lies inside the circumcircle (exact)
  // The mesh against the input it was made from.
  input_not_planar,    ///< the input's segments cross or overlap: nothing can be checked against it
  point_missing,       ///< a point of the input lies in the domain and is not a vertex
  segment_missing,     ///< no chain of subsegments runs from one end of an input segment to the other
  unknown_subsegment,  ///< a chain of subsegments joins input points that no input segment joins
  off_segment,         ///< a vertex of a chain is off its input segment, or out of order along it
  wrong_marker,        ///< a subsegment does not carry the marker of its input segment
  not_covered,         ///< a part of the domain along an input segment has no triangles
  outside_filled,      ///< a triangle lies outside the outer boundary
  hole_filled,         ///< a triangle lies in a hole
  wrong_polygons,      ///< the repaired input has another domain, or other regions, than the polygons as given
  wrong_area,          ///< the triangles' areas do not sum to the area of the domain
  wrong_euler,         ///< counts of triangles, vertices and boundary edges do not fit the domain's topology
  wrong_region,        ///< a triangle does not carry the attribute of the region it lies in
  wrong_point_marker,  ///< a point of the input does not carry its marker
  wrong_attribute,     ///< a point of the input does not carry its attributes
  // Quality.
  small_angle,  ///< an angle below the bound that nothing in the input explains
  large_area,   ///< an area above the bound
};
inline constexpr std::size_t kFlawCount = to_index(Flaw::large_area) + 1;

/// The name of the kind in words: "not Delaunay".
[[nodiscard]] const char* flaw_name(Flaw flaw);

/// Counts every finding of each kind and keeps the messages of the first few.
class Findings {
 public:
  explicit Findings(std::size_t listed_per_kind = 5) : listed_per_kind_(listed_per_kind) {}

  /// Counts one finding; `describe` is called only when its message will be kept.
  template <class Describe>
  void add(Flaw flaw, const Describe& describe) {
    Kind& kind = kinds_[flaw];
    if (kind.count++ < listed_per_kind_) kind.messages.push_back(describe());
  }

  /// Adds what another part of the same check has found after this one.
  void append(const Findings& later);

  [[nodiscard]] bool empty() const { return total() == 0; }
  [[nodiscard]] std::size_t listed_per_kind() const { return listed_per_kind_; }
  [[nodiscard]] std::uint64_t total() const;
  [[nodiscard]] std::uint64_t count(Flaw flaw) const { return kinds_[flaw].count; }
  /// The kept messages: each names the triangle, edge or vertex, and the actual and the expected value.
  [[nodiscard]] const std::vector<std::string>& messages(Flaw flaw) const { return kinds_[flaw].messages; }

 private:
  struct Kind {
    std::uint64_t count = 0;
    std::vector<std::string> messages;
  };
  IdVector<Flaw, Kind> kinds_ = IdVector<Flaw, Kind>(kFlawCount);
  std::size_t listed_per_kind_;
};

}  // namespace driftmesh
