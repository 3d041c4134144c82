#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "driftmesh/pslg.hpp"

namespace driftmesh::oracles {

/// A random input whose domain is known from how it was made.
struct RandomPslg {
  Pslg input;
  std::vector<std::size_t> boundary_segments;  ///< indices of the segments with the domain on one side only
};

struct RandomPslgShape {
  int outer_points = 12;      ///< points on the outer boundary, a star-shaped polygon
  int holes = 2;              ///< star-shaped, at most; as many as fit
  int rings = 1;              ///< closed rings of segments that are regions, at most
  int inner_segments = 6;     ///< segments between points that exist, at most
  int dangling_segments = 2;  ///< segments from a point that exists to a new one in the domain, at most
  int inner_points = 5;       ///< points without a segment
  double spikiness = 0.5;     ///< 0: round boundaries; toward 1: thin spikes with small angles
  double scale = 1;           ///< size of the whole
  double offset = 0;          ///< distance of the whole from the origin, in both coordinates
};

/// Planar: segments meet only at common ends, points lie on no segment (by exact predicates).
[[nodiscard]] RandomPslg make_random_pslg(std::uint64_t seed, const RandomPslgShape& shape);

/// A random shape, small enough for brute-force oracles. Same seed, same shape.
[[nodiscard]] RandomPslgShape make_random_shape(std::uint64_t seed);

}  // namespace driftmesh::oracles
