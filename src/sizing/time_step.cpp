#include "sizing/time_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "raster/greatest_in_triangle.hpp"
#include "sizing/water_waves.hpp"

namespace driftmesh {
namespace {

constexpr double kEnough = 1 + 1e-8;
// Floors over the length that a depth asks for. The circumradius of a triangle with a larger area than the equilateral
// one with an edge of 2 lengths exceeds 2 / sqrt(3) of them, so its circumcenter is farther than that from all
// vertices. If it encroaches upon a segment of length L instead, it is in a lens of 120 degrees, in which all points
// are within L / sqrt(3) of an end. So L exceeds 2 lengths, and the halves of the segment are longer than one (for
// angle bounds up to 30 degrees, beyond which lenses are wider). The factor for altitudes is measured.
constexpr double kForEdges = 2;
constexpr double kForAltitudes = 2.6;
constexpr double kForHalves = 2.05;

/// The shortest edge or altitude.
double length_of(const CornerPoints& t, CourantLength which) {
  std::array<double, 3> squared{squared_distance(t[0], t[1]), squared_distance(t[1], t[2]),
                                squared_distance(t[2], t[0])};
  std::ranges::sort(squared);
  if (which == CourantLength::kEdge) return std::sqrt(squared[0]);
  CornerPoints sorted = t;  // rounding must not depend on the order
  std::ranges::sort(sorted, [](const Point& a, const Point& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  return 2 * std::abs(signed_area(sorted[0], sorted[1], sorted[2])) / std::sqrt(squared[2]);
}

}  // namespace

double TimeStep::length_for(double depth) const {
  return courant_length(depth, rule_.step, rule_.bound, rule_.speed);
}

double TimeStep::room(const CornerPoints& triangle) const {
  return length_of(triangle, rule_.length) / needed(triangle);
}

double TimeStep::needed(const CornerPoints& triangle) const {
  return length_for(greatest_in(*depth_, triangle));
}

bool TimeStep::allowed(const CornerPoints& triangle) const {
  const double length = length_of(triangle, rule_.length);
  if (length >= kEnough * length_for(depth_->over(Box::of(triangle)).high)) return true;
  return length >= kEnough * length_for(greatest_in(*depth_, triangle));
}

double TimeStep::floor_for(double depth) const {
  return (rule_.length == CourantLength::kEdge ? kForEdges : kForAltitudes) * length_for(depth);
}

double TimeStep::floor_around(const Box& box) const {
  const double margin = std::max(box.high.x - box.low.x, box.high.y - box.low.y) / 2;
  return floor_for(depth_->over(Box::around(box.low, box.high, margin)).high);
}

double TimeStep::floor(const CornerPoints& triangle) const {
  return floor_around(Box::of(triangle));
}

double TimeStep::floor_between(const Point& a, const Point& b) const {
  return kForHalves / kForEdges * floor_around(Box::around(a, b));
}

double TimeStep::least_floor() const {
  return floor_for(0);
}

double TimeStep::floor_at(const Point& p) const {
  return floor_for(depth_->at(p));
}

}  // namespace driftmesh
