#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesh/bounds.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

/// Why a triangle may stay below the angle bound.
enum class ExceptionCause : std::uint8_t {
  kUnexplained,  ///< no accepted reason
  kInputAngle,   ///< its smallest angle lies between two constrained edges: it is an angle of the input
  kShell,        ///< its shortest edge joins two segments of one acute corner at the same distance from the apex
  kPrecision,    ///< coordinates are too coarse for a point that would help
};

/// The reason of triangle t, judged by its neighborhood: never kPrecision.
[[nodiscard]] ExceptionCause cause_of(const Triangulation& mesh, TriangleId t);

/// The triangles of a refined mesh that miss the angle or the area bound, by cause. Examines every triangle anew and
/// relies on nothing that the refiner has recorded.
struct Exceptions {
  struct Item {
    TriangleId triangle;
    ExceptionCause cause;
    double smallest_angle;  ///< degrees
  };
  std::vector<Item> skinny;  ///< below the angle bound
  std::vector<TriangleId>
      large;  ///< above their area bound: empty unless refinement was stopped early or precision ran out
};

/// The distribution of the angles of a mesh, and its areas.
struct AngleSummary {
  double smallest = 180;                ///< degrees
  double largest = 0;                   ///< degrees
  std::array<std::int64_t, 18> bins{};  ///< number of angles from 10 i to 10 (i + 1) degrees
  double smallest_area = 0, largest_area = 0, total_area = 0;
};

/// What there is to say about the triangles of a refined mesh, in one pass over them.
struct Inspection {
  Exceptions exceptions;
  AngleSummary shape;
};
[[nodiscard]] Inspection inspect(const Triangulation& mesh, const QualityBounds& bounds);
[[nodiscard]] inline Exceptions find_exceptions(const Triangulation& mesh, const QualityBounds& bounds) {
  return inspect(mesh, bounds).exceptions;
}
[[nodiscard]] inline AngleSummary summarize_angles(const Triangulation& mesh) {
  return inspect(mesh, {}).shape;
}

}  // namespace driftmesh
