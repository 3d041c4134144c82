#pragma once

#include <memory>

#include "driftmesh/time_step.hpp"
#include "geometry/triangle_geometry.hpp"
#include "raster/raster.hpp"

namespace driftmesh {

/// What a time step asks of the triangles of a mesh. Answers depend neither on the order of corners nor on who asks.
class TimeStep {
 public:
  /// Depths in meters, positive downward.
  TimeStep(const CourantRule& rule, std::shared_ptr<const Raster> depth) : rule_(rule), depth_(std::move(depth)) {}

  [[nodiscard]] const CourantRule& rule() const { return rule_; }

  /// The factor by which the step could be longer in this triangle: at least 1 where its Courant number is within the
  /// bound.
  [[nodiscard]] double room(const CornerPoints& triangle) const;
  /// How long the shortest edge or altitude of this triangle has to be.
  [[nodiscard]] double needed(const CornerPoints& triangle) const;
  /// Whether the step is allowed there, with a margin for readers who round differently.
  [[nodiscard]] bool allowed(const CornerPoints& triangle) const;

  /// The edge that a triangle may have, whatever size is asked for there, since smaller triangles around it might not
  /// allow the step: that of the equilateral triangle with its area. Refinement puts points into circumcenters, at
  /// least 1 / sqrt(3) times this edge away from all others; what is measured beyond that is for segments that are
  /// split. The depth is the greatest in a box around the triangle that holds most of what an insertion changes.
  [[nodiscard]] double floor(const CornerPoints& triangle) const;
  /// The same for a very small triangle, for forecasts.
  [[nodiscard]] double floor_at(const Point& p) const;
  /// The least value of floor_at, whatever the depth.
  [[nodiscard]] double least_floor() const;
  /// The length that an edge between subdomains may have, which is halved where it is longer.
  [[nodiscard]] double floor_between(const Point& a, const Point& b) const;
  /// Deleting vertices may leave triangles with edges this many times the floor.
  static constexpr double kThinned = 1.3;

 private:
  /// The length that the depth asks for.
  [[nodiscard]] double length_for(double depth) const;
  [[nodiscard]] double floor_for(double depth) const;
  [[nodiscard]] double floor_around(const Box& box) const;

  CourantRule rule_;
  std::shared_ptr<const Raster> depth_;
};

}  // namespace driftmesh
