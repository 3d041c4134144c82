#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "driftmesh/defaults.hpp"
#include "driftmesh/pslg.hpp"
#include "driftmesh/size_field.hpp"
#include "sizing/time_step.hpp"

namespace driftmesh {

/// What bounds the sizes of triangles in plain values, as requests, plans and checks hand it on.
struct PlainBounds {
  double area = 0;           ///< largest area of a triangle; <= 0: no bound
  bool region_areas = true;  ///< whether the area bounds of the input's regions apply
};

/// Where refinement may put points, and how many. Where it may not, triangles miss bounds. Only for meshes in one
/// piece.
struct InsertionRules {
  /// The constrained segments that may be split.
  enum class Split : std::uint8_t {
    kEverywhere,
    kInside,   ///< those with the domain on both sides
    kNowhere,  ///< none: every segment of the input is one edge of the mesh
  };
  Split split = Split::kEverywhere;
  /// Whether segments are split until no vertex that can see one lies inside its diametral circle. Then every triangle
  /// is Delaunay, not only constrained Delaunay. Near segments that may not be split this does not hold.
  bool conforming = false;
  std::int64_t most_points = INT64_MAX;  ///< refinement ends when it has added this many
  friend bool operator==(const InsertionRules&, const InsertionRules&) = default;
};

/// The bounds that every triangle of a finished mesh must meet. Lengths and areas are in the units of the input's
/// coordinates.
struct QualityBounds {
  double min_angle = defaults::kMinAngle;  ///< degrees; 0: no bound
  PlainBounds plain{};
  /// Bound of each region label (see triangulate), <= 0 for none; empty if regions set no bounds.
  std::vector<double> region_max_area{};
  /// Target edge length as a function of position, or null. Not owned.
  const SizeField* size = nullptr;
  /// The time step that triangles are to allow, before all bounds on their size, or null. Not owned.
  const TimeStep* step = nullptr;
  InsertionRules rules{};
};

/// The largest angle bound that is accepted, in degrees. In practice refinement terminates on every input up to about
/// 33 degrees; proofs stop earlier (docs/guarantees.md).
inline constexpr double kMaxAngle = 34;

/// The area bounds that an input sets by region labels; 0 for label 0, which is outside all regions.
[[nodiscard]] std::vector<double> areas_by_region(const Pslg& pslg);

/// Throws Error if the angle bound lies outside [0, kMaxAngle].
void require_possible(double min_angle);

/// Twice the area of the equilateral triangle with edges of length h.
[[nodiscard]] inline double twice_area_of_edge(double h) {
  return h * h * (std::numbers::sqrt3 / 2);
}

/// The edge of the equilateral triangle of which this is twice the area.
[[nodiscard]] inline double edge_of_twice_area(double twice_area) {
  return std::sqrt(twice_area * (2 / std::numbers::sqrt3));
}

inline constexpr double kNoBound = std::numeric_limits<double>::infinity();

}  // namespace driftmesh
