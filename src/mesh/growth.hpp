#pragma once

#include <algorithm>
#include <cmath>

namespace driftmesh {

/// How fast triangles may grow away from a detail of the input, for an angle bound. Around a point where edges have
/// length s, refinement makes about density / (s + slope r)^2 triangles per area at distance r: sizes grow linearly
/// (Ruppert, "A Delaunay refinement algorithm for quality 2-dimensional mesh generation", 1995, theorem 3), by no more
/// than the angle bound allows. Both constants were fitted to refined meshes.
struct Growth {
  double density;
  double slope;
};

/// By interpolation in a table of measurements. `min_angle`: degrees, 0 to kMaxAngle.
[[nodiscard]] Growth growth_of(double min_angle);

/// Triangles on an area.
struct Covered {
  double triangles = 0;
  double area = 0;
  Covered& operator+=(const Covered& c) {
    triangles += c.triangles;
    area += c.area;
    return *this;
  }
};

/// A corner of a triangle, as far as the growth away from it is concerned.
struct GrowthCorner {
  double angle;      ///< radians
  double near, far;  ///< lengths of its edges, near <= far
  double opposite;   ///< length of the third
  double area;       ///< area of the triangle
};

/// The integral of the density over a triangle, away from a corner where edges have length `size`: the triangles that
/// are there because of this corner. Beyond the distance `reach`, others decide: only what is nearer counts.
///
/// Closed forms for a sector around the corner and, beyond the nearer neighbor, a strip that tapers off; exact for a
/// sector and for needles, else within some percent.
[[nodiscard]] Covered grown_from(const GrowthCorner& corner, double size, double reach, const Growth& growth);

/// The integral of w(x) / (s0 + x (s1 - s0) / length)^2 for x from 0 to `length`, where the width w goes linearly from
/// w0 to w1: triangles, up to a factor, on a strip with sizes from s0 to s1.
[[nodiscard]] double integrate_strip(double length, double w0, double w1, double s0, double s1);

/// The integral of 1 / s along a line of this length where s goes linearly from s0 to s1: edges along it.
[[nodiscard]] double integrate_line(double length, double s0, double s1);

}  // namespace driftmesh
