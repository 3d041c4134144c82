#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "driftmesh/point.hpp"

namespace driftmesh {

/// A finished mesh, or one rank's piece of it, as flat arrays: what writers write, readers read back, checks check and
/// pictures show. Independent of the structure that the refiner works on. All indices count from 0. Arrays that say
/// "empty, or" have either no entry or exactly one for each point or triangle.
///
/// What the mesher returns is a constrained Delaunay triangulation: triangles are counterclockwise, no two overlap,
/// every point is a corner of a triangle, and `edges` contains the whole boundary of the domain. What a reader returns
/// is as the file has it (see read_mesh), and verify() tells whether these hold.
struct Mesh {
  /// A constrained subsegment: an edge of the mesh that is a segment of the input or a part of one.
  struct Edge {
    std::int32_t a = 0;       ///< index into points
    std::int32_t b = 0;       ///< index into points
    std::int32_t marker = 0;  ///< that of the segment
    friend bool operator==(const Edge&, const Edge&) = default;
  };

  std::vector<Point> points;                           ///< in the coordinates of the input
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< vertex indices, counterclockwise
  std::vector<Edge> edges;                             ///< every constrained subsegment once, in either direction
  std::vector<std::int32_t> point_markers;  ///< empty, or one for each point; 0 for points that the mesher put inside
  std::vector<double> attributes;           ///< attributes_per_point values for each point, point by point
  std::int32_t attributes_per_point = 0;
  std::vector<double> regions;  ///< empty, or the attribute of each triangle's region; 0 outside all regions

  // Only for a mesh that was made in subdomains, or a rank's piece of one.
  std::vector<std::int64_t> numbers;     ///< empty, or the number of each point of a piece in the whole mesh
  std::vector<std::int32_t> subdomains;  ///< empty, or the subdomain in which each triangle was made
  std::vector<std::int32_t> ranks;       ///< empty, or the rank that held the subdomain of each triangle at the end
};

}  // namespace driftmesh
