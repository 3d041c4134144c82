#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "driftmesh/mesh.hpp"
#include "driftmesh/options.hpp"
#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// What check() found. Angles are in degrees, areas in squared units of the coordinates.
struct CheckReport {
  /// One kind of flaw.
  struct Finding {
    std::string kind;                   ///< in words: "not Delaunay"
    std::uint64_t count = 0;            ///< all flaws of this kind
    std::vector<std::string> examples;  ///< the first few: the triangle, edge or point, and what is wrong with it
  };

  bool accepted = false;          ///< whether there are no findings
  std::vector<Finding> findings;  ///< kinds that were found
  std::string text;               ///< the report of `driftmesh check`, in lines
  std::string verdict;            ///< its last line: "accepted: ..." with what was checked, or "rejected: ..."

  std::int64_t points = 0;
  std::int64_t triangles = 0;
  std::int64_t subsegments = 0;
  double area = 0;  ///< sum over all triangles
  double smallest_area = 0;
  double largest_area = 0;
  double smallest_angle = 0;
  double largest_angle = 0;
  std::array<std::uint64_t, 180> angles{};  ///< [d]: the number of angles from d up to d + 1 degrees
  std::int64_t exceptions = 0;              ///< triangles that miss a bound for an accepted reason: small input angles
  double courant = 0;                       ///< the greatest Courant number, if a time step is asked for
  std::int64_t triangles_above = 0;         ///< those with a greater one than asked for; findings if options.strict
};

/// Checks a mesh, however it was made; shares no code with the mesher but the exact predicates. It must be a
/// constrained Delaunay triangulation that meets the bounds of `options` on angles (20 degrees unless given otherwise,
/// as for mesh()), areas and sizes. How to make a mesh, or how many triangles, is of no interest here, except for
/// `threads`, by which the check is done. docs/guarantees.md says which exceptions are accepted.
///
/// What is wrong with the mesh is reported, never thrown. Throws Error for options that are out of range.
[[nodiscard]] CheckReport check(const Mesh& mesh, const MeshOptions& options = {});

/// Also checks the mesh against its input, which is repaired first as by mesh(), with options.snap, options.hull,
/// options.simplify, options.close_channels and options.holes: it must cover its domain and nothing else, and have its
/// segments, points, markers, attributes and regions. Polygons are read a second time as they are, unless they are
/// snapped or simplified. Throws InputError for an input that cannot be repaired.
///
/// \code
/// const driftmesh::Pslg bay = driftmesh::generate("bay", {{"resolution", "1000"}});
/// const driftmesh::MeshOptions bounds{.min_angle = 25, .max_area = 5e6};
/// const driftmesh::CheckReport report = driftmesh::check(driftmesh::mesh(bay, bounds), bay, bounds);
/// if (!report.accepted) std::cerr << report.text;
/// assert(report.accepted && report.largest_area <= 5e6);
/// \endcode
[[nodiscard]] CheckReport check(const Mesh& mesh, const Pslg& input, const MeshOptions& options = {});

}  // namespace driftmesh
