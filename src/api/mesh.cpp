#include <utility>

#include "api/call.hpp"
#include "api/library_request.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/mesher.hpp"
#include "job/one_piece.hpp"
#include "job/thread_run.hpp"
#include "job/triangulated.hpp"
#include "mesh/interpolate_attributes.hpp"
#include "mesh/to_piece.hpp"

namespace driftmesh {
namespace {

Mesh in_one_piece(Call& call, const job::Domain& domain, job::Triangulated&& triangulated) {
  const job::OnePiece made =
      job::mesh_in_one_piece(call.request(), domain, std::move(triangulated), true, call.watch(), false);
  if (!made.result.complete) {
    const auto triangles = static_cast<std::int64_t>(made.result.mesh.live_triangles());
    throw LimitError(job::stopped_message(made.limits, made.by_memory, triangles, true));
  }
  Mesh mesh = to_piece(made.result.mesh, domain.pslg);
  interpolate_attributes(domain.pslg, mesh);
  return mesh;
}

Mesh in_subdomains(Call& call, job::Domain&& domain, const job::Triangulated& triangulated) {
  const std::int32_t threads = call.threads();
  job::Order order = call.order(std::move(domain), triangulated, job::kSubdomains, threads);
  job::ThreadRun run(std::move(order), threads, call.given().size, call.watch());
  run.refine();
  Mesh mesh = run.assemble().mesh;
  mesh.numbers.clear();  // only for points of a piece; this is the whole mesh
  mesh.ranks.clear();
  return mesh;
}

Mesh mesh_by(Call& call) {
  const job::Place place = call.place();
  call.check(place);
  job::Domain domain = call.read_domain();
  job::Triangulated triangulated =
      job::triangulate_domain(call.request(), domain, 1, job::cut_of(call.request(), place), call.watch());
  return triangulated.cut ? in_subdomains(call, std::move(domain), triangulated)
                          : in_one_piece(call, domain, std::move(triangulated));
}

}  // namespace

Mesh mesh(const Pslg& input, const MeshOptions& options) {
  return with_words_of_options([&] {
    Call call(input, options);
    return mesh_by(call);
  });
}

}  // namespace driftmesh
