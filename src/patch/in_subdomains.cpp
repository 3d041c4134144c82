#include "patch/in_subdomains.hpp"

#include <string>

#include "balancer/stealing/policy_stealing.hpp"
#include "distributed/assembly.hpp"
#include "distributed/held_subdomains.hpp"
#include "distributed/ranks.hpp"
#include "driftmesh/error.hpp"
#include "mesh/handles.hpp"
#include "runtime/plan_run.hpp"
#include "runtime/threads/refinement_in_rounds.hpp"

namespace driftmesh::patch {
namespace {

RunPlan plan_of(const Triangulation& domain, const QualityBounds& bounds, double forecast, std::size_t threads) {
  constexpr std::int32_t kAnyThreads = 2;  // no mesh depends on the number
  const DecomposeOptions cutting{.subdomains = 0, .bounds = bounds, .forecast = forecast};
  PlanOptions options;
  options.mapping.ranks = static_cast<std::int32_t>(threads);
  if (threads > 1) options.balancing.policy = "stealing";
  return plan_run(decompose_for(domain, cutting, kAnyThreads), bounds, options,
                  threads > 1 ? balancer::stealing_maker() : nullptr);
}

}  // namespace

void refuse_many(std::int64_t most_triangles) {
  const bool limited = most_triangles < kMostRefined;
  throw LimitError(
      "lengths ask for more than " + std::to_string(most_triangles) + " triangles in what is made anew" +
      (limited ? "; ask for longer ones, or allow more triangles" : ", which no mesh has; ask for longer ones"));
}

Mesh refine_in_subdomains(const Triangulation& domain, const Pslg& pslg, const QualityBounds& bounds,
                          std::span<const SizeField* const> sizes, double forecast, std::int64_t most_triangles) {
  const RunPlan plan = plan_of(domain, bounds, forecast, sizes.size());
  const auto check = [&](std::int64_t triangles) {
    if (triangles > most_triangles) refuse_many(most_triangles);
  };
  RefinementInRounds refinement(plan, sizes, {.check = check});
  refinement.run();
  PieceAssembly assembly(Rank{0}, 1, plan.decomposition, held_by_rank(refinement.subdomains()));
  OneRank alone;
  alone.run(assembly);
  return assembly.piece(pslg).mesh;
}

}  // namespace driftmesh::patch
