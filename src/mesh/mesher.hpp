#pragma once

#include <cstdint>
#include <functional>

#include "mesh/bounds.hpp"
#include "mesh/refine_counters.hpp"
#include "mesh/triangulation.hpp"
#include "pslg/pslg.hpp"

namespace driftmesh {

/// What the mesher is asked for.
struct MeshRequest {
  double min_angle = 20;                            ///< degrees, 0 to kMaxAngle
  double max_area = 0;                              ///< <= 0: no bound
  bool region_areas = true;                         ///< whether the regions' own area bounds hold
  const SizeField* size = nullptr;                  ///< target edge lengths, or null; not owned
  std::int64_t max_triangles = kMaxTriangles - 64;  ///< stop there
};

/// A refined mesh with what is known of its making.
struct MeshResult {
  Triangulation mesh;
  QualityBounds bounds;  ///< as they were applied
  bool complete = true;  ///< false: stopped at max_triangles; the mesh is valid but misses bounds
  std::int32_t acute_corners = 0;
  RefineCounters counters;
  double seconds_triangulate = 0;  ///< constrained Delaunay triangulation, carving, corners
  double seconds_refine = 0;
};

/// The bounds that a request sets on the mesh of `pslg`, whose region labels index them.
[[nodiscard]] QualityBounds bounds_of(const Pslg& pslg, const MeshRequest& request);

/// Called before refinement and now and then during it, with the present and the forecast number of triangles. What it
/// throws ends the work and passes through.
using MeshProgress = std::function<void(std::int64_t triangles, double forecast)>;

/// Meshes the domain of a repaired PSLG (see repair): triangulate, prepare acute corners, refine. The whole domain as
/// one subdomain. Deterministic. Throws Error for requests out of range and for inputs that triangulate refuses.
[[nodiscard]] MeshResult mesh_domain(const Pslg& pslg, const MeshRequest& request, const MeshProgress& progress = {});

/// The second half of that: refines `result.mesh`, triangulated and with its corners prepared, to `result.bounds`, and
/// fills in the rest. Stops at `max_triangles`.
void refine_domain(MeshResult& result, std::int64_t max_triangles, const MeshProgress& progress = {});

}  // namespace driftmesh
