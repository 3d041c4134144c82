#include "job/prepare.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "balancer/stealing/policy_stealing.hpp"
#include "decompose/decompose.hpp"
#include "decompose/decomposition_file.hpp"
#include "decompose/same_input.hpp"
#include "decompose/same_segments.hpp"
#include "driftmesh/policy_parameters.hpp"
#include "job/key.hpp"
#include "mapping/mapping_file.hpp"
#include "mesh/size_bound.hpp"
#include "pslg/seeded_random.hpp"
#include "runtime/plan_run.hpp"

namespace driftmesh::job {
namespace {

std::int32_t wanted_subdomains(const Request::Decomposition& asked, std::int32_t ranks) {
  if (asked.subdomains > 0) return asked.subdomains;
  return static_cast<std::int32_t>(std::min<std::int64_t>(std::int64_t{asked.subdomains_per_rank} * ranks, INT32_MAX));
}

Decomposition given_decomposition(const Decomposition& decomposition, const Pslg& input, const Triangulation& domain) {
  const std::string name = "the decomposition";
  require_same_input(decomposition, input, name);
  require_same_segments(decomposition, domain, name);
  return decomposition;
}

Decomposition read_decomposition_of(const std::string& file, const Pslg& input, const Triangulation& domain) {
  Decomposition decomposition = read_decomposition(file, input);
  require_same_segments(decomposition, domain, file);
  return decomposition;
}

Decomposition decomposition_of(const Request& request, const Domain& domain, const Given& given,
                               const Triangulated& triangulated, std::int32_t ranks, Watch& watch) {
  if (given.decomposition != nullptr) {
    if (request.decomposition.subdomains != 0)
      throw KeyError("decomposition.subdomains", "cannot be combined with a given decomposition", "remove one");
    return given_decomposition(*given.decomposition, domain.pslg, triangulated.mesh);
  }
  const std::string& file = request.decomposition.file;
  if (!file.empty())
    return timed(watch, "load", [&] { return read_decomposition_of(file, domain.pslg, triangulated.mesh); });
  return timed(watch, "decompose", [&] { return cut(request, triangulated, ranks); });
}

/// Multiplies each forecast by a random factor between 1 / most and most, all magnitudes as likely.
void disturb_forecasts(Decomposition& decomposition, double most, std::uint64_t seed) {
  SeededRandom random(seed);
  for (auto& subdomain : decomposition.subdomains) subdomain.predicted *= std::pow(most, random.uniform(-1, 1));
}

void check_presplit(const Request& request, const SizeBounds& sizes) {
  const bool sized = sizes.any();
  if (request.run.presplit == Presplit::kOn && !sized)
    throw KeyError("run.presplit", "is on, but nothing says how long the pieces of interfaces may be",
                   "give {bounds.area}, {bounds.triangles} or {sizing.size}, or remove it");
  if (request.run.method == Method::kDecoupled && !sized)
    throw KeyError("run.method", "is decoupled, but nothing says how long the pieces of interfaces may be",
                   "give {bounds.area} or {bounds.triangles}, or use the coupled method");
}

/// The number of ranks for which the number of subdomains is chosen. Not that of threads, on which no mesh depends:
/// they share the subdomains that any number of them would have.
std::int32_t ranks_to_suit(PlaceKind place, std::size_t ranks) {
  constexpr std::int32_t kAnyThreads = 2;
  return place == kSubdomains ? kAnyThreads : static_cast<std::int32_t>(ranks);
}

/// Threads take work from each other: that needs no planner, and moves cost nothing.
constexpr const char* kPolicyOfThreads = "stealing";

balancer::PolicyMaker policies_of(const Given& given, PlaceKind place, std::size_t ranks) {
  if (place != kSubdomains) return given.policies;
  if (ranks == 1) return nullptr;
  return balancer::stealing_maker();
}

Balancing balancing_of(const Request& request, PlaceKind place, std::size_t ranks) {
  Balancing balancing;
  balancing.policy = request.balance.policy;
  if (place == kSubdomains && ranks > 1) balancing.policy = kPolicyOfThreads;
  balancing.parameters = parameters_of_policy(request);
  balancing.options.look = request.balance.look;
  balancing.options.gap = request.balance.gap;
  balancing.options.interval = request.balance.interval;
  balancing.options.worth.gain = request.balance.gain;
  if (place == kSimulated) {  // the cost of moves is known
    balancing.options.cost.latency = request.cluster.latency + 2 * request.cluster.message_overhead;
    balancing.options.cost.bandwidth = request.cluster.bandwidth;
    balancing.options.reference_speed /= request.cluster.scale;
    balancing.options.work_to_start /= request.cluster.scale;
  }
  return balancing;
}

PlanOptions plan_options(const Request& request, PlaceKind place, const IdVector<Rank, double>& speeds) {
  PlanOptions options;
  options.mapping.ranks = static_cast<std::int32_t>(speeds.size());
  options.mapping.method = request.mapping.method;
  if (request.mapping.by_area) options.mapping.weight = MappingWeight::kArea;
  options.mapping.speeds = request.mapping.by_speed ? speeds : IdVector<Rank, double>(request.mapping.speeds);
  if (place == kSimulated && !request.mapping.to_late_ranks)
    options.mapping.absent = late_ranks_of(cluster_of(request));
  options.presplit = request.run.presplit;
  options.work.aggregation = static_cast<std::size_t>(request.run.aggregation);
  options.work.slice = request.run.slice;
  options.work.order = request.run.order;
  options.work.sleep = request.run.sleep;
  options.work.decoupled = request.run.method == Method::kDecoupled;
  if (place == kRanks) options.work.threads = std::max(1, request.run.threads);
  options.balancing = balancing_of(request, place, speeds.size());
  return options;
}

}  // namespace

Decomposition cut(const Request& request, const Triangulated& triangulated, std::int32_t ranks) {
  DecomposeOptions cutting;
  cutting.subdomains = wanted_subdomains(request.decomposition, ranks);
  cutting.min_angle = request.decomposition.separator_angle;
  cutting.bounds = triangulated.bounds;
  cutting.forecast = triangulated.forecast;
  cutting.skew = request.decomposition.skew;
  cutting.seed = static_cast<std::uint64_t>(request.seed);
  return decompose_for(triangulated.mesh, cutting, ranks);
}

void plan_anew(RunPlan& plan, const Request& request, PlaceKind place, const IdVector<Rank, double>& speeds) {
  const PlanOptions options = plan_options(request, place, speeds);
  plan.work = options.work;
  plan.balancing = options.balancing;
  prepare_balancing(plan, options.mapping.ranks, policies_of({}, place, speeds.size()));
}

Prepared prepare(const Request& request, const Domain& domain, const Triangulated& triangulated, const Given& given,
                 PlaceKind place, const IdVector<Rank, double>& speeds, Watch& watch) {
  Prepared prepared;
  prepared.acute_corners = triangulated.acute_corners;
  check_presplit(request, triangulated.bounds);
  Decomposition decomposition =
      decomposition_of(request, domain, given, triangulated, ranks_to_suit(place, speeds.size()), watch);
  if (request.decomposition.forecast_error > 1)
    disturb_forecasts(decomposition, request.decomposition.forecast_error, static_cast<std::uint64_t>(request.seed));
  prepared.plan = timed(watch, "map", [&] {
    PlanOptions options = plan_options(request, place, speeds);
    if (!request.mapping.file.empty())
      options.owners =
          read_mapping(request.mapping.file, static_cast<std::int32_t>(decomposition.size()), options.mapping.ranks);
    return plan_run(std::move(decomposition), triangulated.bounds, options, policies_of(given, place, speeds.size()));
  });
  prepared.forecast = forecast_of(prepared.plan);
  return prepared;
}

}  // namespace driftmesh::job
