#pragma once

#include <cstddef>

namespace driftmesh {

/// sRGB, each from 0 to 1.
struct Rgb {
  double red = 0;
  double green = 0;
  double blue = 0;
};

/// The perceptually uniform color map viridis at t (clamped to 0..1): dark violet, blue-green, yellow. By Nathaniel
/// Smith and Stefan van der Walt, released under CC0; interpolated here from nine of its colors.
[[nodiscard]] Rgb viridis(double t);

/// Colors of equal lightness that differ as much as possible from their predecessors, for categories without an order.
[[nodiscard]] Rgb category_color(std::size_t index);
/// Darker colors of the same hues, for lines.
[[nodiscard]] Rgb category_line_color(std::size_t index);

// The colors of everything that is not data.
inline constexpr Rgb kInk{0.13, 0.14, 0.18};
inline constexpr Rgb kFaintInk{0.45, 0.47, 0.52};
inline constexpr Rgb kPaper{1, 1, 1};
inline constexpr Rgb kPlainFill{0.91, 0.94, 0.97};
inline constexpr Rgb kAlarm{0.80, 0.20, 0.18};

}  // namespace driftmesh
