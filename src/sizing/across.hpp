#pragma once

namespace driftmesh {

/// Edges are asked for that are this much shorter than an even share of the width. Some edges are longer than that of
/// the equilateral triangle of the same area, but with 1 already all 400 random channels had all layers asked for, 2 to
/// 12 (a twentieth of 60,000 crossings with 3 asked for had no more, and none had fewer). The rest is margin.
inline constexpr double kFinerAcross = 1.05;

/// The narrowest channel for which a length is short enough for this many layers of triangles; see LocalWidth.
[[nodiscard]] constexpr double width_for(double length, int layers) {
  return length * kFinerAcross * layers;
}

}  // namespace driftmesh
