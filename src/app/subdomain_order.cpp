#include "app/subdomain_order.hpp"

#include <algorithm>
#include <utility>

#include "app/mesh_outputs.hpp"
#include "balancer/policies/policy_factory.hpp"
#include "base/keep_memory.hpp"
#include "distributed/piece_series.hpp"
#include "job/prepare.hpp"
#include "job/rank_report.hpp"

namespace driftmesh::app {
namespace {

using job::Request;

job::Use use_in_subdomains(const Request& request, bool in_one_process) {
  return {.in_subdomains = true,
          .sleeps = request.run.sleep || !request.run.scratch.empty(),
          .stores = !request.run.scratch.empty(),
          .writes = writes(request.output),
          .gathers = gathers(request.output) && !in_one_process};
}

void check_capacity(const Request& request, const job::Prepared& prepared, const job::Use& use,
                    const job::Processes& processes) {
  double subdomain = 0;
  for (const Decomposition::Subdomain& s : prepared.plan.decomposition.subdomains)
    subdomain = std::max(subdomain, s.predicted);
  const double file = (processes.all == 1 ? writes_whole : gathers)(request.output)
                          ? prepared.forecast
                          : prepared.forecast * use.at_once / processes.all;
  job::check_capacity(subdomain, writes(request.output) ? file : 0, use.by);
}

}  // namespace

job::Order order_of(const Request& request, job::Domain&& domain, const job::Triangulated& triangulated,
                    job::Place place, const IdVector<Rank, double>& shares, const job::Processes& processes,
                    RunNotes& notes) {
  job::Use use = use_in_subdomains(request, processes.all == 1);
  if (place == job::kSubdomains && !writes_whole(request.output))  // each thread a piece
    use.at_once = std::min(1.0, static_cast<double>(shares.size()) * kTrianglesInSeries / triangulated.forecast);
  job::Limits limits = job::find_limits(request.limits, domain.pslg, use, processes);
  if (triangulated.forecast > static_cast<double>(limits.in_memory)) {
    use.sleeps = true;
    limits = job::find_limits(request.limits, domain.pslg, use, processes);
  }
  job::Prepared prepared =
      job::prepare(request, domain, triangulated, {.policies = balancer::make_policy}, place, shares, limits, notes);
  check_capacity(request, prepared, use, processes);
  prepared.plan.work.sleep = use.sleeps;
  job::add_prepared(notes.run, prepared);
  domain.pslg.holes = triangulated.holes;
  return {std::move(prepared.plan), std::move(domain.pslg),   request.sizing, request.limits, shares, use,
          request.run.scratch,      std::move(domain.rasters)};
}

void reuse_memory(const Request::Limits& limits) {
  if (limits.max_memory == 0) keep_freed_memory();
}

}  // namespace driftmesh::app
