#include "mesh/mesher.hpp"

#include "base/stopwatch.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "mesh/forecast.hpp"
#include "mesh/refiner.hpp"

namespace driftmesh {
namespace {

/// Insertions between two reports: a few milliseconds, and about a megabyte.
constexpr std::int64_t kReportEvery = 10'000;

}  // namespace

QualityBounds bounds_of(const Pslg& pslg, const MeshRequest& request) {
  QualityBounds bounds{request.min_angle, request.max_area, {}, request.size};
  if (!request.region_areas) return bounds;
  bounds.region_max_area.push_back(0);  // label 0: outside all regions
  for (const Pslg::Region& r : pslg.regions) bounds.region_max_area.push_back(r.max_area);
  return bounds;
}

MeshResult mesh_domain(const Pslg& pslg, const MeshRequest& request, const MeshProgress& progress) {
  MeshResult result;
  result.bounds = bounds_of(pslg, request);
  const Stopwatch triangulating;
  result.mesh = triangulate(pslg);
  result.acute_corners = prepare_corners(result.mesh, {request.min_angle, false});
  result.seconds_triangulate = triangulating.seconds();
  const double forecast = progress ? forecast_triangles(result.mesh, result.bounds) : 0;
  refine_domain(result, request.max_triangles, forecast, progress);
  return result;
}

void refine_domain(MeshResult& result, std::int64_t max_triangles, double forecast, const MeshProgress& progress) {
  const Stopwatch refining;
  Refiner refiner(result.mesh, result.bounds);
  refiner.limit_triangles(max_triangles);
  const auto goes_on = [&] {
    return !progress || progress(static_cast<std::int64_t>(result.mesh.live_triangles()), forecast);
  };
  Refiner::Status status = Refiner::Status::kBudget;
  while (goes_on() && status == Refiner::Status::kBudget) status = refiner.refine(progress ? kReportEvery : INT64_MAX);
  result.complete = status == Refiner::Status::kDone;
  result.counters = refiner.counters();
  result.seconds_refine = refining.seconds();
}

}  // namespace driftmesh
