#include "pslg/noise.hpp"

#include <cmath>
#include <utility>

#include "pslg/shape_builder.hpp"

namespace driftmesh {
namespace {

double fade(double t) {
  return t * t * t * (t * (6 * t - 15) + 10);
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
  const std::uint8_t column = order_[static_cast<std::size_t>(x & 255)];
  const Point& g = gradients_[order_[static_cast<std::size_t>((column + y) & 255)]];
  return g.x * dx + g.y * dy;
}

double GradientNoise::operator()(const Point& p) const {
  const double fx = std::floor(p.x), fy = std::floor(p.y);
  const auto x = static_cast<std::int64_t>(fx), y = static_cast<std::int64_t>(fy);
  const double dx = p.x - fx, dy = p.y - fy;
  const double south = mix(corner(x, y, dx, dy), corner(x + 1, y, dx - 1, dy), fade(dx));
  const double north = mix(corner(x, y + 1, dx, dy - 1), corner(x + 1, y + 1, dx - 1, dy - 1), fade(dx));
  return mix(south, north, fade(dy));
}

double GradientNoise::fractal(const Point& p, int octaves, double gain) const {
  double sum = 0, height = 1, frequency = 1;
  for (int i = 0; i < octaves; ++i) {
    // Octaves are shifted, else all would be zero at the same points.
    sum += height * (*this)({p.x * frequency + 17.3 * i, p.y * frequency - 9.7 * i});
    height *= gain;
    frequency *= 2;
  }
  return sum;
}

}  // namespace driftmesh
