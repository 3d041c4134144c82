#include "pslg/noise.hpp"

#include <cmath>
#include <utility>

#include "pslg/shape_builder.hpp"

namespace driftmesh {
namespace {

double fade(double t) {
  return t * t * t * (t * (6 * t - 15) + 10);
}

/// Avoids std::floor, which is a library call unless the compiler may assume SSE4.1.
std::int64_t floor_of(double t) {
  const auto whole = static_cast<std::int64_t>(t);
  return whole - (static_cast<double>(whole) > t ? 1 : 0);
}

double mix(double a, double b, double t) {
  return a + (b - a) * t;
}

}  // namespace

GradientNoise::GradientNoise(SeededRandom& random) {
  for (std::size_t i = 0; i < order_.size(); ++i) order_[i] = static_cast<std::uint8_t>(i);
  for (std::size_t i = order_.size() - 1; i > 0; --i) std::swap(order_[i], order_[random.below(i + 1)]);
  for (Point& g : gradients_) {
    const double angle = random.uniform(0, 2 * kPi);
    g = {std::cos(angle), std::sin(angle)};
  }
}

double GradientNoise::corner(std::int64_t x, std::int64_t y, double dx, double dy) const {
  const std::uint8_t column = order_[x & 255];
  const Point& g = gradients_[order_[(column + y) & 255]];
  return g.x * dx + g.y * dy;
}

double GradientNoise::operator()(const Point& p) const {
  const std::int64_t x = floor_of(p.x), y = floor_of(p.y);
  const double dx = p.x - static_cast<double>(x), dy = p.y - static_cast<double>(y);
  const double south = mix(corner(x, y, dx, dy), corner(x + 1, y, dx - 1, dy), fade(dx));
  const double north = mix(corner(x, y + 1, dx, dy - 1), corner(x + 1, y + 1, dx - 1, dy - 1), fade(dx));
  return mix(south, north, fade(dy));
}

// Octaves are shifted; otherwise all would be zero at the same points.
double GradientNoise::octave(int i, const Point& p) const {
  const double frequency = static_cast<double>(std::int64_t{1} << i);
  return (*this)({p.x * frequency + 17.3 * i, p.y * frequency - 9.7 * i});
}

double GradientNoise::fractal(const Point& p, int octaves, double gain) const {
  double sum = 0, height = 1;
  for (int i = 0; i < octaves; ++i) {
    sum += height * octave(i, p);
    height *= gain;
  }
  return sum;
}

GradientNoise::Range GradientNoise::fractal_range(const Point& p, int known, int octaves, double gain) const {
  double sum = 0, rest = 0, height = 1;
  for (int i = 0; i < octaves; ++i) {
    if (i < known)
      sum += height * octave(i, p);
    else
      rest += height * kBound;
    height *= gain;
  }
  return {sum - rest, sum + rest};
}

bool GradientNoise::fractal_is_below(double bound, const Point& p, int octaves, double gain) const {
  double rest = 0, height = 1;
  for (int i = 0; i < octaves; ++i, height *= gain) rest += height * kBound;
  double sum = 0;
  height = 1;
  for (int i = 0; i < octaves; ++i, height *= gain) {
    if (sum + rest < bound) return true;
    sum += height * octave(i, p);
    rest -= height * kBound;
  }
  return sum < bound;
}

}  // namespace driftmesh
