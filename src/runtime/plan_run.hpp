#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "decompose/decompose.hpp"
#include "mapping/mapping.hpp"
#include "mesh/triangulation.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh {

/// Whether interfaces are cut to size before refinement.
enum class Presplit {
  kAuto,  ///< where the bounds say anything about size
  kOn,    ///< the same, and an error if they do not
  kOff,   ///< never: the protocol of the paper in full
};
/// "auto", "on" or "off". Throws Error for any other name.
[[nodiscard]] Presplit presplit_mode(const std::string& name);

struct PlanOptions {
  MappingOptions mapping;  ///< mapping.ranks: of the run
  Presplit presplit = Presplit::kAuto;
  std::size_t aggregation = protocol::Aggregator::kDefaultThreshold;
  std::int64_t slice = RunPlan{}.slice;
  WorkOrder order = WorkOrder::kGiven;
  bool sleep = false;
  Balancing balancing;
};

/// Subdomains for a mesh of about so many triangles on so many ranks: 20 for each rank, and more where they would
/// otherwise outgrow a second-level cache.
[[nodiscard]] std::int32_t default_subdomains(double triangles, std::int32_t ranks);

/// How many triangles a domain (triangulated, corners prepared) is expected to take within these bounds.
[[nodiscard]] double forecast_triangles(Triangulation mesh, const QualityBounds& bounds);

/// Cuts the domain (triangulated, corners prepared) as `options` say; with options.subdomains = 0 into
/// default_subdomains, or as many as the domain allows. Throws like decompose.
[[nodiscard]] Decomposition decompose_for(const Triangulation& mesh, DecomposeOptions options, std::int32_t ranks);

/// The plan of a run on a decomposition. A policy that is given takes the place of the one that the options name.
/// Throws Error for options out of range or that do not go together.
[[nodiscard]] RunPlan plan_run(Decomposition decomposition, const QualityBounds& bounds, const PlanOptions& options,
                               std::shared_ptr<const balancer::Policy> policy = nullptr);

/// Makes the plan's layout and policy from the rest of it, or takes the policy that is given. Throws InputError for an
/// unknown policy or parameter.
void prepare_balancing(RunPlan& plan, std::int32_t ranks, std::shared_ptr<const balancer::Policy> policy = nullptr);

}  // namespace driftmesh
