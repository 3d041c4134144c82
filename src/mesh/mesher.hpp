#pragma once

#include <cstdint>
#include <functional>

#include "driftmesh/defaults.hpp"
#include "driftmesh/pslg.hpp"
#include "mesh/bounds.hpp"
#include "mesh/refine_counters.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

/// A request to the mesher. All bounds apply: the smallest area counts.
struct MeshRequest {
  double min_angle = defaults::kMinAngle;           ///< bound on angles in degrees, 0 to kMaxAngle; 0: none
  double max_area = 0;                              ///< bound on areas in squared units of the input; <= 0: none
  bool region_areas = true;                         ///< whether the regions' own area bounds apply
  const SizeField* size = nullptr;                  ///< target edge lengths, or null; must outlive the meshing
  std::int64_t max_triangles = kMaxTriangles - 64;  ///< refinement stops when the mesh has this many
};

/// A refined mesh and how it was made.
struct MeshResult {
  Triangulation mesh;
  QualityBounds bounds;            ///< as applied
  bool complete = true;            ///< false: stopped before; the mesh is valid but misses bounds
  std::int32_t acute_corners = 0;  ///< clusters of segments that meet at less than 60 degrees (see prepare_corners)
  RefineCounters counters;
  double seconds_triangulate = 0;  ///< constrained Delaunay triangulation, carving, corners
  double seconds_refine = 0;
};

/// The bounds that a request sets on the mesh of `pslg`, whose region labels index them.
[[nodiscard]] QualityBounds bounds_of(const Pslg& pslg, const MeshRequest& request);

/// Called before refinement and every few milliseconds during it with the present and the forecast number of triangles.
/// Returns whether to go on; if not, the mesh is incomplete. An exception that it throws ends the meshing and reaches
/// the caller.
using MeshProgress = std::function<bool(std::int64_t triangles, double forecast)>;

/// Meshes the domain of a repaired PSLG (see repair) in one piece: triangulates it, prepares acute corners, refines.
///
/// The result is a constrained Delaunay mesh that conforms to the segments. Every triangle meets the bounds on angle
/// and area except those that find_exceptions() lists with a cause: angles of the input, pairs of points on segments
/// that meet at an acute corner, and places where double precision has no room for another point. Refinement terminates
/// for every angle bound up to kMaxAngle in practice; docs/guarantees.md says what is proven (Shewchuk 2002; Chew 1993;
/// Ungor 2004). Deterministic: the same input and request give the same bits.
///
/// Throws Error for a request out of range and for inputs that triangulate() refuses, LimitError when there are more
/// than kMaxTriangles triangles, and whatever `request.size` or `progress` throws.
[[nodiscard]] MeshResult mesh_domain(const Pslg& pslg, const MeshRequest& request, const MeshProgress& progress = {});

/// The second half of the above: refines `result.mesh`, triangulated and with its corners prepared, to `result.bounds`,
/// and fills in the rest. Stops at `max_triangles`. `forecast`: for `progress`.
void refine_domain(MeshResult& result, std::int64_t max_triangles, double forecast = 0,
                   const MeshProgress& progress = {});

}  // namespace driftmesh
