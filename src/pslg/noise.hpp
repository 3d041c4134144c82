#pragma once

#include <array>
#include <cstdint>

#include "driftmesh/point.hpp"
#include "pslg/seeded_random.hpp"

namespace driftmesh {

/// Gradient noise in the plane (K. Perlin, "Improving noise", SIGGRAPH 2002): smooth, zero at integer points, about
/// -0.7 to 0.7, without visible period below 256.
class GradientNoise {
 public:
  explicit GradientNoise(SeededRandom& random);
  [[nodiscard]] double operator()(const Point& p) const;
  /// A sum of `octaves` noises, each with twice the frequency and `gain` times the amplitude of the one before.
  [[nodiscard]] double fractal(const Point& p, int octaves, double gain) const;

  /// The range of a fractal sum of which some octaves are known.
  struct Range {
    double low, high;
  };
  /// Adds octaves of fractal() until it is certain that the sum is below `bound`, or all `octaves` are known.
  [[nodiscard]] bool fractal_is_below(double bound, const Point& p, int octaves, double gain) const;
  /// The range of fractal() after its first `known` octaves.
  [[nodiscard]] Range fractal_range(const Point& p, int known, int octaves, double gain) const;

 private:
  static constexpr double kBound = 0.75;  // largest value of one noise, rounded up from sqrt(1/2)
  [[nodiscard]] double octave(int i, const Point& p) const;
  [[nodiscard]] double corner(std::int64_t x, std::int64_t y, double dx, double dy) const;
  std::array<std::uint8_t, 256> order_{};
  std::array<Point, 256> gradients_{};
};

}  // namespace driftmesh
