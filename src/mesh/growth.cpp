#include "mesh/growth.hpp"

#include <iterator>
#include <numbers>

namespace driftmesh {
namespace {

struct Measured {
  double angle;  // degrees
  Growth growth;
};
constexpr Measured kMeasured[] = {{0, {2.3, 2.5}},     {5, {2.0, 1.9}},     {10, {1.42, 1.15}},  {15, {1.6, 1.0}},
                                  {20, {1.27, 0.683}}, {25, {1.71, 0.611}}, {28, {1.81, 0.526}}, {30, {1.95, 0.475}},
                                  {32, {2.13, 0.4}},   {33, {2.1, 0.34}},   {34, {2.05, 0.3}}};

/// Relative changes below this are treated as none: the closed forms would cancel.
constexpr double kLevel = 1e-4;

/// The integral of r / (1 + r)^2 from 0 to x.
double sector(double x) {
  return x < 0.02 ? x * x * (1.0 / 2 - x * (2.0 / 3 - x * (3.0 / 4))) : std::log1p(x) - x / (1 + x);
}

Covered cover_sector(double angle, double radius, double size, const Growth& g) {
  return {g.density * angle / (g.slope * g.slope) * sector(g.slope * radius / size), angle * radius * radius / 2};
}

/// A strip that starts at distance `from` from the corner with this width and tapers off over `length`.
Covered cover_taper(double from, double length, double width, double size, double reach, const Growth& g) {
  const double part = std::min(length, reach - from);
  if (!(part > 0)) return {};
  const double end = width * (1 - part / length);
  const double start_size = size + g.slope * from;
  return {g.density * integrate_strip(part, width, end, start_size, start_size + g.slope * part),
          part * (width + end) / 2};
}

}  // namespace

Growth growth_of(double min_angle) {
  const auto* above = std::upper_bound(std::begin(kMeasured) + 1, std::end(kMeasured) - 1, min_angle,
                                       [](double angle, const Measured& m) { return angle < m.angle; });
  const auto* below = above - 1;
  const double share = std::clamp((min_angle - below->angle) / (above->angle - below->angle), 0.0, 1.0);
  return {std::lerp(below->growth.density, above->growth.density, share),
          std::lerp(below->growth.slope, above->growth.slope, share)};
}

double integrate_strip(double length, double w0, double w1, double s0, double s1) {
  const double r = s1 / s0 - 1;
  if (std::fabs(r) < kLevel) return 2 * length * (w0 + w1) / ((s0 + s1) * (s0 + s1));
  return length / (s0 * s0) * (w0 / (1 + r) + (w1 - w0) * (std::log1p(r) - r / (1 + r)) / (r * r));
}

double integrate_line(double length, double s0, double s1) {
  const double r = s1 / s0 - 1;
  return length / s0 * (std::fabs(r) < kLevel ? 1 / (1 + r / 2) : std::log1p(r) / r);
}

Covered grown_from(const GrowthCorner& c, double size, double reach, const Growth& g) {
  if (!(reach > 0) || !(c.angle > 0)) return {};
  const double within = c.angle * c.near * c.near / 2;  // the area of the sector up to the nearer neighbor
  if (within < c.area && c.near < 0.98 * c.far) {
    Covered sum = cover_sector(c.angle, std::min(c.near, reach), size, g);
    const double length = c.far - c.near;
    sum += cover_taper(c.near, length, 2 * (c.area - within) / length, size, reach, g);
    return sum;
  }
  const double height = 2 * c.area / c.opposite;
  constexpr double kLevelCorner = 0.3;
  if (reach <= height || (height > kLevelCorner * c.near && c.far < 2 * c.near))
    return cover_sector(c.angle, std::min(std::sqrt(2 * c.area / c.angle), reach), size, g);
  // An obtuse corner over a long edge: two tapering arms.
  constexpr double kMeanDistance = 0.3;  // between points across the start of an arm, relative to its width
  Covered sum;
  for (const double arm : {c.near, c.far}) {
    const double length = std::sqrt(std::max(0.0, arm * arm - height * height));
    sum += cover_taper(0, length, height, size + kMeanDistance * g.slope * height, reach, g);
  }
  return sum;
}

}  // namespace driftmesh
