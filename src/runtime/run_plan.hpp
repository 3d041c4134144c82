#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "balancer/policy_interface/policy_list.hpp"
#include "balancer/snapshot/effort.hpp"
#include "balancer/trigger/controller_options.hpp"
#include "base/scratch_file.hpp"
#include "decompose/decomposition.hpp"
#include "decompose/presplit.hpp"
#include "driftmesh/defaults.hpp"
#include "driftmesh/ids.hpp"
#include "driftmesh/load_snapshot.hpp"
#include "driftmesh/policy.hpp"
#include "driftmesh/policy_parameters.hpp"
#include "mesh/bounds.hpp"
#include "migration/beginning.hpp"
#include "runtime/agenda.hpp"

namespace driftmesh {

/// Which policy moves subdomains between ranks during a run, and when.
struct Balancing {
  std::string policy = "none";  ///< see balancer/policy_interface/policy_list.hpp
  balancer::Parameters::Values parameters;
  balancer::ControllerOptions options;
};

/// That an insertion adds, but for points on borders.
inline constexpr double kTrianglesPerPoint = 2;

/// How each rank works, the same on all ranks.
struct WorkSettings {
  std::size_t aggregation = defaults::kAggregation;  ///< most SPLITs in one message
  /// Insertions between polls of the transport: some milliseconds, and most subdomains in one go.
  std::int64_t slice = defaults::kSlice;
  WorkOrder order = WorkOrder::kGiven;
  /// Presplit interfaces get no more points: nobody tells anybody anything, and a subdomain that needs one is an error.
  bool decoupled = false;
  bool sleep = false;        ///< compress finished subdomains to a quarter of their memory until a neighbor needs them
  std::int32_t threads = 1;  ///< number per rank, where ranks are real
};

/// What the loops of all ranks know from the start, whatever they work on; equal on all of them.
struct LoopPlan {
  IdVector<SubdomainId, Rank> owners;  ///< at the start
  WorkSettings work;
  std::int64_t max_triangles = INT64_MAX;  ///< on one rank; more is a LimitError

  Balancing balancing;
  std::shared_ptr<const balancer::Layout> layout;  ///< null without balancing
  std::shared_ptr<const balancer::Policy> policy;  ///< null without balancing
};

/// What every rank of a parallel run knows from the start, equal on all ranks. prepare_balancing makes layout and
/// policy from the rest.
struct RunPlan : LoopPlan {
  Decomposition decomposition;
  QualityBounds bounds;
  bool presplit = false;
  std::shared_ptr<const PresplitPaths> presplit_paths;           ///< null: each side of an interface computes them
  const IdVector<SubdomainId, Beginning>* beginnings = nullptr;  ///< see SubdomainContext; not owned
  ScratchFile* scratch = nullptr;  ///< this process's, for subdomains that sleep; not owned; null: memory
};

/// Costs of a rank's work on the reference machine, in seconds, used for simulated time. Measured with
/// `driftmesh_bench_costs` (docs/benchmarks.md).
struct CostModel {
  double cut = 0.4e-6;          ///< cutting the domain, per subdomain and halving that leads to it
  double start = 29e-6;         ///< the initial triangulation of a subdomain
  double prepared = 0.17e-6;    ///< more for each of its triangles
  double point = 0.229e-6;      ///< a point inserted by refinement
  double listed = 20e-9;        ///< a subdomain that balancing looks at
  double packed_byte = 0.4e-9;  ///< a byte of a subdomain that is packed or unpacked
  double asleep = 23e-9;        ///< a triangle of a subdomain that falls asleep
  double woken = 40e-9;         ///< a triangle of a subdomain that wakes
  balancer::PlanningCosts planning;
};

}  // namespace driftmesh
