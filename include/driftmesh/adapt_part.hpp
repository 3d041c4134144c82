#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "driftmesh/adaptive.hpp"
#include "driftmesh/defaults.hpp"
#include "driftmesh/mesh.hpp"
#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// How parts of a finished mesh are made anew.
struct PartOptions {
  /// The length of edges that is wanted at each point of the mesh, linear between points, > 0; empty: that of the
  /// triangles that there are.
  std::vector<double> lengths{};
  /// Bounds on lengths and how fast they grow; most_triangles: what is made anew has no more. coarsening does not
  /// count.
  AdaptiveOptions sizes{};
  double min_angle =
      defaults::kMinAngle;  ///< new triangles have it, in degrees, except where the outline has smaller ones
  /// Names of point data (Mesh::attribute_names) whose integrals stay, as by Transfer::kConserve; all others are
  /// interpolated. None with a new outline.
  std::vector<std::string> conserve{};
  /// Lines of both outlines that are so near to each other are the same; 0: as near as rounding puts them.
  double tolerance = 0;
  /// The most threads that work at once where much is made anew; nothing else depends on their number. 0: one for each
  /// core.
  std::int32_t threads = 0;
};

/// A mesh of which parts are new.
struct AdaptedMesh {
  Mesh mesh;
  std::vector<std::int32_t> old_points;     ///< for each point its number in the old mesh; -1: it is new
  std::vector<std::int32_t> old_triangles;  ///< the same for triangles
  std::int64_t margin = 0;                  ///< triangles that are gone because of the angle bound alone
  double margin_width = 0;                  ///< no corner of these is farther from what had to be made anew
  std::int64_t beyond = 0;                  ///< new points where the old mesh was not
};

/// Makes these triangles of a mesh anew, given by their numbers, and as many around them as the bound on angles takes.
/// The mesh may be that of another program: its outline, markers, regions and names are those of its edges. Everything
/// beyond stays bit for bit: points, triangles with the order of their corners, edges, markers, point data, and
/// numbers, but that the last points and triangles get numbers that have become free. The new triangles and those
/// beyond are constrained Delaunay together if those beyond are so among themselves. Point data come along, those at
/// triangles do not.
///
/// Throws Error for numbers out of range, triangles that are clockwise or do not fit together, and options out of
/// range, and LimitError.
///
/// \code
/// driftmesh::Mesh plate = driftmesh::mesh(driftmesh::generate("rectangle-hole"), {.max_area = 0.01});
/// const std::vector<std::int32_t> part{0, 1, 2};
/// const driftmesh::AdaptedMesh finer = driftmesh::adapt_part(plate, part, {.sizes = {.longest = 0.01}});
/// std::cout << finer.mesh.triangles.size() - plate.triangles.size() << " more triangles\n";
/// \endcode
[[nodiscard]] AdaptedMesh adapt_part(Mesh mesh, std::span<const std::int32_t> triangles,
                                     const PartOptions& options = {});

/// Gives a mesh a new domain, which is repaired first: what touches a line that is on one of both outlines alone is
/// made anew, and as much around it as the bound on angles takes; all else stays as with adapt_part(). Edges that stay
/// keep their markers, new ones have those of the domain. Where the domain is beyond the old mesh, lengths and point
/// data are those at its nearest place. Also throws InputError for a domain that cannot be repaired, and for one
/// without regions where the mesh has some.
///
/// \code
/// driftmesh::Pslg port;
/// port.points = {{0, 0}, {4, 0}, {4, 3}, {0, 3}};
/// port.segments = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 0, 1}};
/// const driftmesh::Mesh before = driftmesh::mesh(port, {.max_area = 0.01});
/// port.points[2] = {4, 2.5};  // a quay is built
/// const driftmesh::AdaptedMesh after = driftmesh::adapt_outline(before, port);
/// assert(after.mesh.triangles.size() < before.triangles.size());
/// \endcode
[[nodiscard]] AdaptedMesh adapt_outline(Mesh mesh, const Pslg& domain, const PartOptions& options = {});

}  // namespace driftmesh
