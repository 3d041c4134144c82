#include "bench/driftmesh_mesher.hpp"

#include <utility>
#include <vector>

#include "base/stopwatch.hpp"
#include "bench/child_process.hpp"
#include "bench/cut.hpp"
#include "bench/shape.hpp"
#include "mesh/cdt.hpp"
#include "mesh/mesher.hpp"
#include "mesh/to_piece.hpp"

namespace driftmesh::bench {
namespace {

void count(const Triangulation& mesh, ShapeCensus& census) {
  for (const TriangleId t : ids_of(mesh.triangles))
    if (mesh.triangles[t].alive()) census.add(shape_of(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)));
}

void measure(const Triangulation& mesh, MeshRun& run) {
  ShapeCensus census;
  count(mesh, census);
  census.store(run);
  run.vertices = static_cast<std::int64_t>(mesh.live_vertices());
}

MeshRun triangulate_domain(const Pslg& pslg) {
  MeshRun run;
  const Stopwatch watch;
  const Triangulation mesh = triangulate(pslg);
  run.seconds_cdt = watch.seconds();
  run.peak_bytes = peak_memory();
  measure(mesh, run);
  return run;
}

MeshRequest request_of(const Bounds& bounds) {
  MeshRequest request;
  request.min_angle = bounds.degrees;
  request.max_area = bounds.area;
  request.region_areas = false;
  return request;
}

MeshRun refine(const Pslg& pslg, const Bounds& bounds) {
  MeshRun run;
  const MeshResult result = mesh_domain(pslg, request_of(bounds));
  run.peak_bytes = peak_memory();
  run.seconds_cdt = result.seconds_triangulate;
  run.seconds_refine = result.seconds_refine;
  measure(result.mesh, run);
  return run;
}

}  // namespace

const Mesher kDriftmesh{"driftmesh", triangulate_domain, refine};

std::vector<Pslg> parts_of(const Pslg& pslg, double area, double degrees, std::size_t pieces) {
  // Coarse enough to be cheap, fine enough for parts of similar size.
  constexpr double kTrianglesInPart = 16;
  const Bounds coarse{area / (kTrianglesInPart * static_cast<double>(pieces)), degrees};
  return cut(to_piece(mesh_domain(pslg, request_of(coarse)).mesh, pslg), pslg.holes, pieces);
}

MeshRun refine_parts(const std::vector<Pslg>& parts, const Bounds& bounds) {
  MeshRun run;
  std::vector<Triangulation> meshes;
  meshes.reserve(parts.size());
  for (const Pslg& part : parts) {
    MeshResult result = mesh_domain(part, request_of(bounds));
    run.seconds_cdt += result.seconds_triangulate;
    run.seconds_refine += result.seconds_refine;
    meshes.push_back(std::move(result.mesh));
  }
  run.peak_bytes = peak_memory();
  ShapeCensus census;
  for (const Triangulation& mesh : meshes) {
    count(mesh, census);
    run.vertices += static_cast<std::int64_t>(mesh.live_vertices());
  }
  census.store(run);
  return run;
}

}  // namespace driftmesh::bench
