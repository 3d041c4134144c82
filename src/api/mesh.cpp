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

Mesh in_one_piece(Call& call) {
  call.check(job::kOnePiece);
  const job::Domain domain = job::read_domain(call.request(), call.given(), call.watch());
  const job::OnePiece made = job::mesh_in_one_piece(
      call.request(), domain, job::triangulate_domain(call.request(), domain, 1, job::Cut::kNever, call.watch()), true,
      call.watch(), false);
  if (!made.result.complete) {
    const auto triangles = static_cast<std::int64_t>(made.result.mesh.live_triangles());
    throw LimitError(job::stopped_message(made.limits, made.by_memory, triangles, true));
  }
  Mesh mesh = to_piece(made.result.mesh, domain.pslg);
  interpolate_attributes(domain.pslg, mesh);
  return mesh;
}

Mesh in_subdomains(Call& call) {
  job::ThreadRun run(call.order_for(job::kSubdomains), 1, call.given().size, call.watch());
  run.refine();
  Mesh mesh = run.assemble().mesh;
  mesh.numbers.clear();  // only for points of a piece; this is the whole mesh
  mesh.ranks.clear();
  return mesh;
}

}  // namespace

Mesh mesh(const Pslg& input, const MeshOptions& options) {
  return with_words_of_options([&] {
    Call call(input, options);
    return call.in_subdomains() ? in_subdomains(call) : in_one_piece(call);
  });
}

}  // namespace driftmesh
