#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "driftmesh/names.hpp"
#include "driftmesh/point.hpp"

namespace driftmesh {

/// A finished mesh, or one rank's piece of it, as flat arrays: the common form for writers, readers, the verifier and
/// plots. Independent of the refiner's data structure. All indices start at 0. Arrays documented as "empty, or" have
/// either no entries or exactly one for each point or triangle.
///
/// The mesher returns a constrained Delaunay triangulation: triangles are counterclockwise, no two overlap, every point
/// is a corner of a triangle, and `edges` contains the whole boundary of the domain. Readers return the contents of the
/// file (see read_mesh), and verify() tells whether these properties hold.
///
/// \code
/// const driftmesh::Mesh mesh = driftmesh::mesh(driftmesh::generate("pipe"), {.max_area = 50});
/// double area = 0;
/// for (const auto& [a, b, c] : mesh.triangles) {
///   const driftmesh::Point &p = mesh.points[a], &q = mesh.points[b], &r = mesh.points[c];
///   area += ((q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x)) / 2;
/// }
/// \endcode
struct Mesh {
  /// A constrained subsegment: an edge of the mesh that is a segment of the input or a part of one.
  struct Edge {
    std::int32_t a = 0;       ///< index into points
    std::int32_t b = 0;       ///< index into points
    std::int32_t marker = 0;  ///< the segment's
    friend bool operator==(const Edge&, const Edge&) = default;
  };
  /// Edges of the boundary that water flows over, one after the other, as ADCIRC has them.
  struct Weir {
    std::int32_t type = 0;             ///< ADCIRC's IBTYPE: 3, 13, 23; with two sides 4, 24, 64; with pipes 5, 25
    std::vector<std::int32_t> points;  ///< indices of the points along it
    std::vector<std::int32_t> across;  ///< empty, or the point on the other side for each
    std::vector<double> values;        ///< for each point its 2, 3 or 6 heights, coefficients and diameters
    friend bool operator==(const Weir&, const Weir&) = default;
  };

  std::vector<Point> points;                           ///< in the coordinates of the input
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< vertex indices, counterclockwise
  std::vector<Edge> edges;                             ///< every constrained subsegment once, in either direction
  std::vector<std::int32_t> point_markers;  ///< empty, or one for each point; 0 for interior points added by the mesher
  std::vector<double> attributes;           ///< attributes_per_point values for each point, point by point
  std::int32_t attributes_per_point = 0;
  /// Empty, or what each attribute is called: "depth". A name is as those of markers (see Names), and none of "marker",
  /// "attribute", "global_number" and "vtkGhostType".
  std::vector<std::string> attribute_names;
  std::vector<double> regions;  ///< empty, or the attribute of each triangle's region; 0 outside all regions
  Names names;                  ///< names for markers and regions, also for those that do not occur
  std::vector<Weir> weirs;      ///< read from an ADCIRC grid; only .14 and .grd hold them
  /// What the coordinates of points are; empty: not known. The name of a projection, such as "UTM zone 18N", says that
  /// they are its meters. " of degrees" behind it: the domain was given in longitudes and latitudes, as which grids of
  /// this mesh are written, too.
  std::string coordinates;

  // Only for a mesh made in subdomains, or a rank's piece of one.
  std::vector<std::int64_t> numbers;     ///< empty, or the number of each point of a piece in the whole mesh
  std::vector<std::int32_t> subdomains;  ///< empty, or the subdomain in which each triangle was made
  std::vector<std::int32_t> ranks;       ///< empty, or the rank that held the subdomain of each triangle at the end
};

}  // namespace driftmesh
