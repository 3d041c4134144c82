#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "decompose/decompose.hpp"
#include "driftmesh/options.hpp"
#include "mapping/mapping.hpp"
#include "mesh/triangulation.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh {

struct PlanOptions {
  MappingOptions mapping;               ///< mapping.ranks: of the run
  Assignment owners;                    ///< replaces what `mapping` would make; empty: it does not
  Presplit presplit = Presplit::kAuto;  ///< kOn is for bounds that limit the size of triangles
  WorkSettings work;
  Balancing balancing;
};

/// The number of subdomains for a mesh of about this many triangles on this many ranks: 20 per rank, and more if they
/// would otherwise exceed a second-level cache.
[[nodiscard]] std::int32_t default_subdomains(double triangles, std::int32_t ranks);

/// Triangles to be made that are worth being made in subdomains where nobody asks for it: a tenth of a second of work.
inline constexpr double kWorthCutting = 500'000;

/// Whether a mesh is to have at least so many more triangles.
[[nodiscard]] bool is_worth_cutting(const Triangulation& mesh, double forecast, double least = kWorthCutting);

/// Cuts the domain (triangulated, corners prepared) as `options` say; with options.subdomains = 0 into
/// default_subdomains, or as many as the domain allows. Throws like decompose.
[[nodiscard]] Decomposition decompose_for(const Triangulation& mesh, DecomposeOptions options, std::int32_t ranks);

/// The plan of a run on a decomposition, with the policy that `policies` makes as options.balancing says; without
/// `policies`, there is only "none". Throws Error for options out of range or that do not go together.
[[nodiscard]] RunPlan plan_run(Decomposition decomposition, const QualityBounds& bounds, const PlanOptions& options,
                               const balancer::PolicyMaker& policies = nullptr);

/// The forecast number of triangles of all ranks, or of the subdomains that one has at the start.
[[nodiscard]] double forecast_of(const RunPlan& plan, std::optional<Rank> rank = {});

/// What a balancer on this number of ranks knows of the plan.
[[nodiscard]] std::shared_ptr<const balancer::Layout> layout_of(const RunPlan& plan, std::int32_t ranks);
/// The same where nothing is known but where subdomains lie and who has them.
[[nodiscard]] std::shared_ptr<balancer::Layout> layout_of(const Decomposition& decomposition,
                                                          const IdVector<SubdomainId, Rank>& holders,
                                                          std::int32_t ranks);

/// Makes the plan's layout and policy from its other members. Throws what `policies` throws.
void prepare_balancing(RunPlan& plan, std::int32_t ranks, const balancer::PolicyMaker& policies);

}  // namespace driftmesh
