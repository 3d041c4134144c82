#pragma once

#include <algorithm>
#include <array>

#include "mesh/triangulation.hpp"

namespace driftmesh {

/// A part of the base of a triangle, a segment, along which another segment runs on the far side of the apex: a
/// channel. Triangles in it cannot be much larger than it is wide.
struct Channel {
  double from, to;     ///< distances from the start of the base
  double width, rise;  ///< at the start of the base (extrapolated), and per length
  [[nodiscard]] double width_at(double along) const { return width + rise * along; }
  [[nodiscard]] double least_width() const { return std::min(width_at(from), width_at(to)); }
};

/// What faces the base of a triangle across its apex.
struct Facing {
  std::array<Channel, 2> channels;
  std::array<SubsegmentId, 2> segments;  ///< the channels are in front of these
  int count = 0;
  bool same_shell = false;  ///< a piece of the same shell: the triangle is in the wedge of an acute corner
};

/// The segments nearest to the base on both sides of the apex of the triangle of half-edge `base`, which is a segment
/// of this length.
[[nodiscard]] Facing facing_segments(const Triangulation& mesh, HalfEdge base, double length);

}  // namespace driftmesh
