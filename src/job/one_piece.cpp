#include "job/one_piece.hpp"

#include <utility>
namespace driftmesh::job {

OnePiece mesh_in_one_piece(const Request& request, const Domain& domain, Triangulated&& triangulated, bool writes,
                           Watch& watch, bool may_keep) {
  OnePiece made;
  made.limits = find_limits(request.limits, domain.pslg, {.writes = writes});
  made.forecast = triangulated.forecast;
  MeshResult& result = made.result;
  result.mesh = std::move(triangulated.mesh);
  result.acute_corners = triangulated.acute_corners;
  result.bounds = std::move(triangulated.bounds);
  if (!request.limits.keep_incomplete)
    check_forecast(made.limits, made.forecast, may_keep, [&] { return find_narrow_place(result.mesh); });
  timed(watch, "refine", [&] {
    refine_domain(result, made.limits.triangles, made.forecast, [&](std::int64_t triangles, double forecast) {
      watch.refining(triangles, forecast);
      made.by_memory = memory_is_full(made.limits, triangles);
      return !made.by_memory;
    });
  });
  return made;
}

}  // namespace driftmesh::job
