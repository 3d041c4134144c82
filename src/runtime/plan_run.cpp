#include "runtime/plan_run.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "balancer/snapshot/experience.hpp"
#include "decompose/presplit.hpp"
#include "decompose/work.hpp"
#include "driftmesh/error.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/forecast.hpp"

namespace driftmesh {
namespace {

/// With their vertices three quarters of a megabyte: what refinement is fastest with
/// (docs/benchmarks.md).
constexpr double kTrianglesPerSubdomain = 20'000;
constexpr std::int32_t kSubdomainsPerRank = 20;

bool on_segments(const Decomposition& d, SubdomainId s) {
  return std::ranges::any_of(d.roots_of(s), [&](GlobalRootId r) { return !d.roots[r].separator; });
}

}  // namespace

std::int32_t default_subdomains(double triangles, std::int32_t ranks) {
  const double for_cache = std::min(std::ceil(triangles / kTrianglesPerSubdomain), 1e6);
  return std::max(kSubdomainsPerRank * ranks, static_cast<std::int32_t>(for_cache));
}

bool is_worth_cutting(const Triangulation& mesh, double forecast, double least) {
  return forecast - static_cast<double>(mesh.live_triangles()) >= least;
}

Decomposition decompose_for(const Triangulation& mesh, DecomposeOptions options, std::int32_t ranks) {
  if (options.subdomains != 0) return decompose(mesh, options);
  if (options.forecast == 0) options.forecast = forecast_triangles(mesh, options.bounds);
  options.subdomains = default_subdomains(options.forecast, ranks);
  for (;; options.subdomains /= 2) {
    try {
      return decompose(mesh, options);
    } catch (const Error&) {
      if (options.subdomains <= 1) throw;  // fewer than the default will do, but not none
    }
  }
}

double forecast_of(const RunPlan& plan, std::optional<Rank> rank) {
  double forecast = 0;
  for (const SubdomainId s : ids_of(plan.owners))
    if (!rank || plan.owners[s] == *rank) forecast += plan.decomposition.subdomains[s].predicted;
  return forecast;
}

RunPlan plan_run(Decomposition decomposition, const QualityBounds& bounds, const PlanOptions& options,
                 const balancer::PolicyMaker& policies) {
  require_possible(bounds.min_angle);
  if (options.work.slice < 1) throw Error("a slice must be at least one insertion");
  const bool sized = SizeBounds(bounds).any();
  RunPlan plan;
  plan.owners = options.owners.empty() ? map_subdomains(decomposition, options.mapping) : options.owners;
  plan.decomposition = std::move(decomposition);
  plan.bounds = bounds;
  plan.presplit = options.presplit != Presplit::kOff && sized;
  plan.work = options.work;
  plan.balancing = options.balancing;
  prepare_balancing(plan, options.mapping.ranks, policies);
  return plan;
}

void prepare_balancing(RunPlan& plan, std::int32_t ranks, const balancer::PolicyMaker& policies) {
  plan.policy.reset();
  if (!policies && plan.balancing.policy == "none") return;
  if (!policies) throw Error("policy '" + plan.balancing.policy + "' cannot be made here: nothing moves in this run");
  auto policy = policies(plan.balancing.policy, plan.balancing.parameters);
  if (policy->placement() == balancer::Placement::kNobody) return;
  plan.policy = std::move(policy);
  plan.layout = layout_of(plan, ranks);
}

std::shared_ptr<const balancer::Layout> layout_of(const RunPlan& plan, std::int32_t ranks) {
  auto layout = layout_of(plan.decomposition, plan.owners, ranks);
  for (const SubdomainId s : ids_of(plan.owners)) {
    const double predicted = plan.decomposition.subdomains[s].predicted;
    layout->subdomains[s].predicted = plan.balancing.options.work_to_start + predicted;
    layout->subdomains[s].on_segments = on_segments(plan.decomposition, s);
  }
  return layout;
}

std::shared_ptr<balancer::Layout> layout_of(const Decomposition& decomposition,
                                            const IdVector<SubdomainId, Rank>& holders, std::int32_t ranks) {
  auto layout = std::make_shared<balancer::Layout>();
  layout->ranks = ranks;
  for (const SubdomainId s : ids_of(holders)) {
    const Point& at = decomposition.subdomains[s].centroid;
    layout->subdomains.push_back({.x = at.x, .y = at.y, .owner = holders[s], .neighbors = {}});
  }
  for (const Interface& i : interfaces(decomposition)) {
    layout->subdomains[i.first].neighbors.push_back({i.second, i.length});
    layout->subdomains[i.second].neighbors.push_back({i.first, i.length});
  }
  return layout;
}

}  // namespace driftmesh
