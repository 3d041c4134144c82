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
  kBadArray,        ///< an array has the wrong length
  kBadIndex,        ///< a triangle or subsegment names a point that does not exist, or the same point twice
  kBadCoordinate,   ///< a used point is not finite or outside the range of the exact predicates
  kDuplicatePoint,  ///< two used points have the same coordinates
  kPiecesDisagree,  ///< a point differs between pieces in coordinates, marker or attributes, or a number is missing
  // The triangulation.
  kNotCounterclockwise,  ///< a triangle is inverted or flat (exact)
  kDuplicateTriangle,    ///< two triangles have the same corners
  kEdgeUsedTwice,        ///< two triangles lie on the same side of an edge
  kOpenEdge,             ///< an edge with one triangle is not a subsegment: a triangle is missing, or a T-junction
  kTangledVertex,        ///< the triangles around a vertex form neither one closed fan nor only open ones
  kStraySubsegment,      ///< a subsegment is not an edge of the mesh
  kDuplicateSubsegment,  ///< a subsegment is listed twice
  kBoundaryCrosses,      ///< two subsegments of the boundary cross, overlap or touch other than at a common end
  kOverlap,              ///< a part of the plane is covered by more than one triangle
  kNotDelaunay,          ///< the point opposite an unconstrained edge lies inside the circumcircle (exact)
  // The mesh against the input it was made from.
  kInputNotPlanar,     ///< the input's segments cross or overlap: nothing can be checked against it
  kPointMissing,       ///< a point of the input lies in the domain and is not a vertex
  kSegmentMissing,     ///< no chain of subsegments runs from one end of an input segment to the other
  kUnknownSubsegment,  ///< a chain of subsegments joins input points that no input segment joins
  kOffSegment,         ///< a vertex of a chain is off its input segment, or out of order along it
  kWrongMarker,        ///< a subsegment does not carry the marker of its input segment
  kNotCovered,         ///< a part of the domain along an input segment has no triangles
  kOutsideFilled,      ///< a triangle lies outside the outer boundary
  kHoleFilled,         ///< a triangle lies in a hole
  kWrongPolygons,      ///< the repaired input has another domain, or other regions, than the polygons as given
  kWrongArea,          ///< the triangles' areas do not sum to the area of the domain
  kWrongEuler,         ///< counts of triangles, vertices and boundary edges do not fit the domain's topology
  kWrongRegion,        ///< a triangle does not carry the attribute of the region it lies in
  kWrongPointMarker,   ///< a point of the input does not carry its marker
  kWrongAttribute,     ///< a point of the input does not carry its attributes
  // Quality.
  kSmallAngle,  ///< an angle below the bound that nothing in the input explains
  kLargeArea,   ///< an area above the bound
  kTimeStep,    ///< a Courant number above the bound, if that counts as a flaw
  kFewAcross,   ///< fewer layers of triangles across a channel than asked for
};
inline constexpr std::size_t kFlawCount = to_index(Flaw::kFewAcross) + 1;

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
