#pragma once

#include <string>
#include <vector>

#include "driftmesh/mesh.hpp"
#include "driftmesh/pslg.hpp"

// Brute-force checks of small meshes, from the raw arrays in exact rationals. Each returns descriptions of the problems
// found.

namespace driftmesh::oracles {

/// The definition of a constrained Delaunay triangulation, without the help of local tests: no vertex that can be seen
/// from inside a triangle, past the subsegments, lies in its circumcircle. O(triangles x points) and O(points x
/// subsegments) for each point in a circle.
[[nodiscard]] std::vector<std::string> check_constrained_delaunay(const Mesh& mesh);

/// Positive areas that sum, exactly, to the area that `boundary` encloses: edges of the mesh, directed with the domain
/// on their left.
[[nodiscard]] std::vector<std::string> check_area(const Mesh& mesh, const std::vector<Mesh::Edge>& boundary);

/// The subsegments with one triangle, directed with it on their left; found by comparing every triangle with every
/// subsegment.
[[nodiscard]] std::vector<Mesh::Edge> find_boundary(const Mesh& mesh);

/// Each input segment inside the domain is covered by subsegments that carry its marker: those with both ends within
/// `tolerance` of it, projected on it, leave no gap and do not overlap, and meet at common vertices. Segments for which
/// `outside(index)` is true must have none.
[[nodiscard]] std::vector<std::string> check_coverage(const Mesh& mesh, const Pslg& input, double tolerance,
                                                      const std::vector<bool>& outside);

/// How many triangles hold the point, its border not counted; -1 if it lies on a border.
[[nodiscard]] int count_covering(const Mesh& mesh, const Point& p);

/// Whether a point lies inside the domain whose carved boundary is `segments` of the input, by the parity of crossings
/// of a ray; segments that are not on the boundary must not be listed.
[[nodiscard]] bool inside_by_parity(const Pslg& input, const std::vector<std::size_t>& boundary_segments,
                                    const Point& p);

}  // namespace driftmesh::oracles
