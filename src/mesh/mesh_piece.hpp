#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/point.hpp"

namespace driftmesh {

/// A finished mesh (or one subdomain's piece of it) as flat arrays: what writers write, readers read back, checks
/// check and pictures show. Independent of the structure that the refiner works on.
struct MeshPiece {
  /// A constrained subsegment: an edge of the mesh that lies on a segment of the input.
  struct Edge {
    std::int32_t a = 0;  ///< index into points
    std::int32_t b = 0;  ///< index into points
    std::int32_t marker = 0;
    friend bool operator==(const Edge&, const Edge&) = default;
  };

  std::vector<Point> points;
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< vertex indices, counterclockwise
  std::vector<Edge> edges;                             ///< every constrained subsegment once
  std::vector<std::int32_t> point_markers;             ///< empty, or one for each point
  std::vector<double> attributes;                      ///< attributes_per_point values for each point, point by point
  std::int32_t attributes_per_point = 0;
  std::vector<double> regions;  ///< empty, or the region attribute of each triangle

  // Of a mesh that was made in subdomains, or of a rank's piece of it; empty otherwise.
  std::vector<std::int64_t> numbers;     ///< of each point of a piece: its number in the whole mesh, from 0
  std::vector<std::int32_t> subdomains;  ///< of each triangle: the subdomain that it was made in
  std::vector<std::int32_t> ranks;       ///< of each triangle: the rank that held that subdomain in the end
};

}  // namespace driftmesh
