#include <memory>
#include <utility>

#include "api/call.hpp"
#include "api/library_request.hpp"
#include "distributed/exchange.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/mesher.hpp"
#include "job/one_piece.hpp"
#include "job/rank_run.hpp"
#include "mesh/interpolate_attributes.hpp"
#include "mesh/to_piece.hpp"

namespace driftmesh {
namespace {

Mesh in_one_piece(Call& call) {
  call.check(job::kOnePiece);
  const job::Domain domain = job::read_domain(call.request(), call.given(), call.watch());
  const job::OnePiece made = job::mesh_in_one_piece(call.request(), domain, true, call.watch(), false);
  if (!made.result.complete) {
    const auto triangles = static_cast<std::int64_t>(made.result.mesh.live_triangles());
    throw LimitError(job::stopped_message(made.limits, made.by_memory, triangles, true));
  }
  Mesh mesh = to_piece(made.result.mesh, domain.pslg);
  interpolate_attributes(domain.pslg, mesh);
  return mesh;
}

Mesh in_subdomains(Call& call) {
  const std::unique_ptr<job::Team> team = job::lone_team();
  job::RankRun run(*team, call.order_for(*team, job::kSubdomains), call.given().size, call.watch());
  run.refine();
  const std::unique_ptr<job::Channel> channel = team->open();
  ExchangeRunner ranks(channel->transport());
  Mesh mesh = run.assemble(ranks).mesh;
  channel->close();
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
