#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "driftmesh/id_vector.hpp"
#include "driftmesh/point.hpp"
#include "mesh/bounds.hpp"
#include "verify/extended.hpp"
#include "verify/size_check.hpp"
#include "verify/words.hpp"

namespace driftmesh {

/// Why a triangle may miss the bound on angles or, in the last case, that on areas.
enum class ExceptionReason : std::uint8_t {
  kInputAngle,  ///< the angle is given by the input: both of its sides are subsegments
  kSmallWedge,  ///< the shortest edge joins, at nearly the same distance from their common end, two input segments that
                ///< meet at less than 60 degrees (a "seditious" edge: Shewchuk and Si 2014; Miller, Pav, Walkington
                ///< 2003)
  kNoRoom,      ///< double precision leaves no room for a point that would help; see Room
};
inline constexpr std::size_t kExceptionReasonCount = 3;
[[nodiscard]] const char* reason_name(ExceptionReason reason);

/// Shape and size of the triangles of a mesh.
struct Quality {
  struct Exceptions {
    std::uint64_t count = 0;
    std::vector<std::string> messages;  ///< the first few
  };

  double smallest_angle = 180;  ///< degrees
  double largest_angle = 0;     ///< degrees
  double total_area = 0;        ///< summed in extended precision with compensation
  double smallest_area = 0;
  double largest_area = 0;
  std::int32_t smallest_angle_triangle = -1;  ///< index in the whole mesh, or in its piece
  std::int32_t largest_angle_triangle = -1;
  std::int32_t largest_area_triangle = -1;
  std::array<std::uint64_t, 180> angles{};  ///< [d]: angles from d up to d + 1 degrees
  IdVector<ExceptionReason, Exceptions> exceptions = IdVector<ExceptionReason, Exceptions>(kExceptionReasonCount);

  /// The histogram in 18 bins of ten degrees.
  [[nodiscard]] std::array<std::uint64_t, 18> angles_by_ten() const;
  [[nodiscard]] std::uint64_t exception_count() const;
  /// Adds the exceptions among later triangles.
  void add_exceptions(const Quality& later, std::size_t max_listed);
};

struct CheckedBounds {
  double min_angle = 0;  ///< degrees; 0: no bound
  PlainBounds plain{};
  std::function<double(std::size_t triangle)> region_area;  ///< empty, or each triangle's own bound (<= 0: none)
  const SizeCheck* size = nullptr;                          ///< target edge lengths; null: none
};

/// A triangle that misses a bound: a flaw unless there is an accepted reason. See Judge.
struct Suspect {
  enum class Miss : std::uint8_t { kAngle, kArea, kSize };

  TrianglePlace place;
  std::array<std::int64_t, 3> numbers{};  ///< numbers of the corners
  std::array<Point, 3> corners{};
  Miss miss = Miss::kAngle;
  double bound = 0;  ///< the largest area, or the length of an edge that is asked for
  Point at{};        ///< where that length is asked for
};

/// The extremes of some triangles.
struct Extremes {
  double largest_cotangent = -std::numeric_limits<double>::infinity();
  double smallest_cotangent = std::numeric_limits<double>::infinity();
  double smallest_twice_area = std::numeric_limits<double>::infinity();
  double largest_twice_area = -std::numeric_limits<double>::infinity();

  void add(const Extremes& other) {
    largest_cotangent = std::max(largest_cotangent, other.largest_cotangent);
    smallest_cotangent = std::min(smallest_cotangent, other.smallest_cotangent);
    smallest_twice_area = std::min(smallest_twice_area, other.smallest_twice_area);
    largest_twice_area = std::max(largest_twice_area, other.largest_twice_area);
  }
};

/// What was measured at some triangles.
struct Measures {
  Quality shapes;  ///< without areas and exceptions
  CompensatedSum twice_area;
  Extremes extremes;
  std::vector<Suspect> suspects;
  bool all_suspects = true;  ///< false: there are too many to keep, and none are

  void add(const Suspect& suspect);
  /// Adds what was measured at later triangles.
  void add(const Measures& later);
  /// What can be said about all of them; exceptions are not known.
  [[nodiscard]] Quality quality() const;
};

/// Measures all triangles. The angle bound is circumradius / shortest edge <= 1 / (2 sin min_angle), with a relative
/// slack of 1e-9 for rounding; triangles that seem to miss a bound in double precision are measured again in extended
/// precision.
[[nodiscard]] Measures measure(const NamedMesh& mesh, const CheckedBounds& bounds, std::size_t threads);
/// Calls take(suspect) for all triangles that miss a bound.
void find_suspects(const NamedMesh& mesh, const CheckedBounds& bounds, const std::function<void(const Suspect&)>& take);

/// The largest circumradius / shortest edge for a bound on angles; 0: no bound.
[[nodiscard]] long double largest_ratio(double min_angle);
/// The shortest edge of a triangle.
struct ShortestEdge {
  std::size_t apex;   ///< the corner opposite
  long double ratio;  ///< circumradius / its length; not positive if the triangle is not counterclockwise
};
[[nodiscard]] ShortestEdge shortest_edge(const std::array<Point, 3>& triangle);
/// The angle at o between oa and ob in degrees, in extended precision.
[[nodiscard]] double degrees_at(const Point& o, const Point& a, const Point& b);

}  // namespace driftmesh
