#include "job/one_piece.hpp"

#include <utility>

#include "job/bounds.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"

namespace driftmesh::job {

OnePiece mesh_in_one_piece(const Request& request, const Domain& domain, bool writes, Watch& watch, bool may_keep) {
  OnePiece made;
  made.limits = find_limits(request.limits, domain.pslg, writes);
  MeshResult& result = made.result;
  timed(watch, "triangulate", [&] {
    result.mesh = triangulate(domain.pslg);
    result.acute_corners = prepare_corners(result.mesh);
  });
  result.bounds = bounds_of(request, domain, result.mesh, 1);
  timed(watch, "refine", [&] {
    refine_domain(result, made.limits.triangles, [&](std::int64_t triangles, double forecast) {
      if (std::exchange(made.forecast, forecast) == 0 && !request.limits.keep_incomplete)
        check_forecast(made.limits, forecast, may_keep);
      watch.refining(triangles, forecast);
    });
  });
  return made;
}

}  // namespace driftmesh::job
