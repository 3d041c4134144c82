#include "bench/driftmesh_mesher.hpp"

#include <cstdint>
#include <memory>
#include <vector>

#include "base/stopwatch.hpp"
#include "bench/child_process.hpp"
#include "bench/cut.hpp"
#include "bench/shape.hpp"
#include "mesh/cdt.hpp"
#include "support/made_mesh.hpp"

namespace driftmesh::bench {
namespace {

MeshRun triangulate_domain(const Pslg& pslg) {
  MeshRun run;
  const Stopwatch watch;
  const Triangulation mesh = triangulate(pslg);
  run.seconds_cdt = watch.seconds();
  run.peak_bytes = peak_memory();
  ShapeCensus census;
  for (const TriangleId t : ids_of(mesh.triangles))
    if (mesh.triangles[t].alive()) census.add(shape_of(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)));
  census.store(run);
  run.vertices = static_cast<std::int64_t>(mesh.live_vertices());
  return run;
}

job::Request request_of(const Bounds& bounds) {
  job::Request request = testing::bounded(bounds.degrees, bounds.area);
  request.bounds.region_areas = false;
  return request;
}

/// A part that was refined, and is kept as refinement left it.
class Part {
 public:
  /// Adds times to the run.
  Part(const Pslg& pslg, const Bounds& bounds, MeshRun& run) {
    const job::Request request = request_of(bounds);
    job::Watch watch;
    refined_ = testing::refined_here(pslg, request, nullptr, record_, watch);
    for (const job::StageTime& stage : record_.stages)
      if (stage.name == "triangulate") run.seconds_cdt += stage.seconds;
    run.seconds_refine += record_.seconds_refine;
  }
  [[nodiscard]] const job::RunRecord& record() const { return record_; }
  /// Frees the rest.
  [[nodiscard]] Mesh take_mesh() {
    job::Watch watch;
    return refined_->take_piece(watch).mesh;
  }

 private:
  job::RunRecord record_;
  std::unique_ptr<job::Refined> refined_;
};

MeshRun refine(const Pslg& pslg, const Bounds& bounds) {
  return refine_parts({pslg}, bounds);
}

}  // namespace

const Mesher kDriftmesh{"driftmesh", triangulate_domain, refine};

std::vector<Pslg> parts_of(const Pslg& pslg, double area, double degrees, std::size_t pieces) {
  // Coarse enough to be cheap, fine enough for parts of similar size.
  constexpr double kTrianglesInPart = 16;
  const Bounds coarse{area / (kTrianglesInPart * static_cast<double>(pieces)), degrees};
  return cut(testing::made(pslg, request_of(coarse)).mesh, pslg.holes, pieces);
}

MeshRun refine_parts(const std::vector<Pslg>& pslgs, const Bounds& bounds) {
  MeshRun run;
  std::vector<Part> parts;
  parts.reserve(pslgs.size());
  for (const Pslg& pslg : pslgs) {
    parts.emplace_back(pslg, bounds, run);
    run.peak_bytes = static_cast<std::int64_t>(parts.back().record().peak_refining);
  }
  ShapeCensus census;
  for (Part& part : parts) {
    const Mesh mesh = part.take_mesh();
    for (const auto& [a, b, c] : mesh.triangles)
      census.add(shape_of(mesh.points[static_cast<std::size_t>(a)], mesh.points[static_cast<std::size_t>(b)],
                          mesh.points[static_cast<std::size_t>(c)]));
    run.vertices += static_cast<std::int64_t>(mesh.points.size());
  }
  census.store(run);
  return run;
}

}  // namespace driftmesh::bench
