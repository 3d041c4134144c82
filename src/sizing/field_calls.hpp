#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace driftmesh {

/// The calls of distance(...) and slope(...) in a size expression, taken out of it: their arguments are markers of
/// segments and names of rasters, not values.
struct FieldCalls {
  /// The expression with variables in place of the calls, padded with blanks so that columns remain those of the
  /// original.
  std::string expression;
  /// What distance_name(k) stands for: sorted, without repetitions; all different. An empty one stands for all
  /// segments.
  std::vector<std::vector<std::int32_t>> markers;
  /// The rasters whose slope is asked for, as slope_name: each once.
  std::vector<std::string> slopes;

  [[nodiscard]] static std::string distance_name(std::size_t k);
  [[nodiscard]] static std::string slope_name(const std::string& raster);
  /// Whether nothing else may have this name.
  [[nodiscard]] static bool reserves(std::string_view name);
};

/// Throws InputError naming the column where an argument is not of its kind.
[[nodiscard]] FieldCalls take_field_calls(const std::string& expression);

}  // namespace driftmesh
