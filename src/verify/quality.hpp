#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "driftmesh/id_vector.hpp"
#include "driftmesh/mesh.hpp"
#include "driftmesh/size_field.hpp"
#include "verify/chains.hpp"
#include "verify/findings.hpp"

namespace driftmesh {

/// Why a triangle may miss the bound on angles or, in the last case, that on areas.
enum class ExceptionReason : std::uint8_t {
  input_angle,  ///< the angle is given by the input: both of its sides are subsegments
  small_wedge,  ///< the shortest edge joins, at nearly the same distance from their common end, two input segments that
                ///< meet at less than 60 degrees (a "seditious" edge: Shewchuk and Si 2014; Miller, Pav, Walkington
                ///< 2003)
  no_room,      ///< double precision leaves no room for a point that would help; see Room
};
inline constexpr std::size_t kExceptionReasonCount = 3;
[[nodiscard]] const char* reason_name(ExceptionReason reason);

/// Shape and size of the triangles of a mesh.
struct Quality {
  struct Exceptions {
    std::uint64_t count = 0;
    std::vector<std::string> messages;  ///< of the first few
  };

  double smallest_angle = 180;  ///< degrees
  double largest_angle = 0;     ///< degrees
  double total_area = 0;        ///< summed in extended precision with compensation
  double smallest_area = 0;
  double largest_area = 0;
  std::int32_t smallest_angle_triangle = -1;
  std::int32_t largest_angle_triangle = -1;
  std::int32_t largest_area_triangle = -1;
  std::array<std::uint64_t, 180> angles{};  ///< [d]: angles from d up to d + 1 degrees
  IdVector<ExceptionReason, Exceptions> exceptions = IdVector<ExceptionReason, Exceptions>(kExceptionReasonCount);

  /// The histogram in 18 bins of ten degrees.
  [[nodiscard]] std::array<std::uint64_t, 18> angles_by_ten() const;
  [[nodiscard]] std::uint64_t exception_count() const;
};

struct CheckedBounds {
  double min_angle = 0;                                     ///< degrees; 0: no bound
  double max_area = 0;                                      ///< 0: no bound
  std::function<double(std::size_t triangle)> region_area;  ///< empty, or each triangle's own bound (<= 0: none)
  const SizeField* size = nullptr;                          ///< or target edge lengths, see SizeField
  double size_spacing = 0;                                  ///< see SizeCheck
  std::size_t max_listed = 5;                               ///< messages kept of each cause of an exception
  std::size_t threads = 1;                                  ///< used if neither region_area nor size are given
};

/// Measures all triangles, and adds those that miss a bound without an accepted reason to `findings`. The angle bound
/// is circumradius / shortest edge <= 1 / (2 sin min_angle), with a relative slack of 1e-9 for rounding; triangles that
/// seem to miss a bound in double precision are measured again in extended precision.
[[nodiscard]] Quality check_quality(const Mesh& mesh, const Chains& chains, const CheckedBounds& bounds,
                                    Findings& findings);

}  // namespace driftmesh
