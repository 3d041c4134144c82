#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "driftmesh/mesh.hpp"
#include "driftmesh/point.hpp"
#include "driftmesh/pslg.hpp"
#include "mesh/mesh_edges.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh::patch {

/// The domain that a mesh is to have from now on.
struct NewDomain {
  Pslg pslg;             ///< repaired, its markers and regions numbered as those of the mesh
  double tolerance = 0;  ///< lines of the old outline that are so near to the new one are on it
  std::string name{};    ///< for messages
};

/// What midpoints may be beside the segments that they are on, by rounding, in coordinates of this size.
[[nodiscard]] double rounding_of_midpoints(const std::vector<Point>& points);

/// Numbers markers and regions of a domain as a mesh does that has the same names. A number that the mesh uses for
/// something else, or under another name, becomes one that it does not use. Adds what is new to the names of the mesh.
void adopt_names(Pslg& domain, Mesh& mesh);

/// A part of a segment of the new outline that the mesh has not. Of equal ends: a point on no segment.
struct Piece {
  std::array<Point, 2> end;
  std::array<std::int32_t, 2> end_marker{};
  std::int32_t marker = 0;
  std::optional<double> left, right;  ///< attributes of regions; none: not in the domain
};

/// How the outline of a mesh, its listed edges, becomes a new one.
struct OutlineMatch {
  std::vector<bool> gone;             ///< for each listed edge, whether it is on no segment with the same on both sides
  std::vector<std::int32_t> markers;  ///< those of the segments that the others are on; one that is gone has its own
  std::vector<Piece> pieces;          ///< what edges leave of the new segments
  std::vector<Point> corners;         ///< the points of the new domain
};

/// `made`: the triangulation of the domain. `index`: of the mesh. Throws Error where the tolerance puts several edges
/// on the same part of a segment.
[[nodiscard]] OutlineMatch match_outlines(const Mesh& mesh, const ConstrainedEdgeIndex& index, const NewDomain& domain,
                                          const Triangulation& made);

/// The attribute of the region of a triangle; of a mesh without regions always 0.
[[nodiscard]] double region_of(const Mesh& mesh, std::int32_t triangle);
[[nodiscard]] double region_of(const Mesh& mesh, const NewDomain& domain, const Triangulation& made,
                               TriangleId triangle);

}  // namespace driftmesh::patch
