#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace driftmesh {

/// The calls of distance(...) in a size expression, taken out of it: their arguments are markers of segments, not
/// values.
struct DistanceCalls {
  /// The expression with the variable name_of(k) in place of each call with the k-th of the lists, padded with blanks
  /// so that columns remain those of the original.
  std::string expression;
  /// Sorted, without repetitions; all different. An empty one stands for all segments.
  std::vector<std::vector<std::int32_t>> markers;

  [[nodiscard]] static std::string name_of(std::size_t k);
};

/// Throws InputError naming the column where an argument is not a whole number.
[[nodiscard]] DistanceCalls take_distance_calls(const std::string& expression);

}  // namespace driftmesh
