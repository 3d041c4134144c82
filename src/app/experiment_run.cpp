#include "app/experiment_run.hpp"

#include <algorithm>
#include <cmath>

#include "app/json_text.hpp"
#include "app/lattice_run.hpp"
#include "app/summary.hpp"
#include "balancer/policies/policy_factory.hpp"
#include "base/stopwatch.hpp"
#include "cluster/hindsight.hpp"
#include "config/costs_file.hpp"
#include "config/value_json.hpp"
#include "job/check.hpp"
#include "job/prepare.hpp"
#include "job/rank_report.hpp"
#include "job/simulated/run_simulated.hpp"
#include "job/triangulated.hpp"
#include "runtime/plan_run.hpp"

namespace driftmesh::app {
namespace {

using config::Json;

constexpr std::size_t kRecordedSamples = 200;  // of the load over time, in a record

/// Triangles per second of real ranks in this run, assuming that all ranks are equally fast without drag.
IdVector<Rank, double> measured_speeds(const ClusterRun& run, IdVector<Rank, double> shares) {
  double seconds = 0;  // that one rank would have needed for the work
  for (const Rank r : ids_of(shares)) seconds += run.ranks[r].times.computing * shares[r];
  for (double& share : shares) share *= static_cast<double>(run.triangles()) / seconds;
  return shares;
}

CostModel costs_of(const job::Request& request) {
  return request.cluster.costs.empty() ? CostModel{} : config::read_costs(request.cluster.costs);
}

/// Speeds of the ranks as known before the run; for real ranks, only the ratios.
IdVector<Rank, double> known_speeds(const job::Request& request, const RealCluster* cluster) {
  return cluster == nullptr ? speeds_of(job::cluster_of(request), costs_of(request))
                            : job::shares_of_time(request, cluster->ranks());
}

job::Use use_of(const job::Request& request) {
  return {.by = job::kExperiment, .in_subdomains = true, .sleeps = request.run.sleep};
}

/// Empty if none does.
IdVector<Rank, protocol::SpeedSchedule> changing_speeds(const job::Request& request) {
  if (request.cluster.changes.empty()) return {};
  return schedules_of(job::cluster_of(request));
}

double ideal_of(const ExperimentRun& run, const IdVector<Rank, protocol::SpeedSchedule>& schedules) {
  return schedules.empty() ? ideal_seconds(run.outcome, run.speeds) : ideal_seconds(run.outcome, run.speeds, schedules);
}

void end_preparation(ExperimentRun& run, const Stopwatch& since, job::Watch& watch) {
  run.record.warnings = watch.take_warnings();
  run.record.stages.push_back({"prepare", since.seconds()});
}

void run_real(ExperimentRun& run, RealCluster& cluster, job::Prepared&& prepared, job::Domain&& domain,
              job::Watch& watch) {
  run.plan = prepared.plan;
  run.outcome = cluster.run({std::move(prepared.plan),
                             std::move(domain.pslg),
                             run.request.sizing,
                             run.request.limits,
                             run.speeds,
                             use_of(run.request),
                             {},
                             std::move(domain.rasters)},
                            run.record, watch);
  run.speeds = measured_speeds(run.outcome, run.speeds);
}

/// `since`: the run began.
void run_in_subdomains(ExperimentRun& run, RealCluster* cluster, job::Domain&& domain, const job::Limits& limits,
                       const Stopwatch& since, job::Watch& watch) {
  const job::Request& request = run.request;
  const bool real = cluster != nullptr;
  const auto ranks = static_cast<std::int32_t>(run.speeds.size());
  job::Prepared prepared = job::prepare(
      request, domain, job::triangulate_domain(request, domain, ranks, job::Cut::kAlways, watch),
      {.policies = balancer::make_policy}, real ? job::kRanks : job::kSimulated, run.speeds, limits, watch);
  job::add_prepared(run.record, prepared);
  end_preparation(run, since, watch);
  const Stopwatch running;
  if (real) {
    run_real(run, *cluster, std::move(prepared), std::move(domain), watch);
  } else {
    run.outcome = job::run_simulated(request, prepared, limits, costs_of(request), run.record, watch);
    run.plan = std::move(prepared.plan);
  }
  const auto schedules = changing_speeds(request);
  run.ideal = ideal_of(run, schedules);
  run.work = work_done(run.outcome, run.speeds, schedules);
  run.oracle = oracle_seconds(run.work, run.speeds, schedules);
  run.record.stages.push_back({real ? "run" : "simulate", running.seconds()});
  run.plan.bounds.size = nullptr;
}

/// There is nothing to map better: the ideal is that of the oracle, too.
void run_on_lattice(ExperimentRun& run, const job::Domain& domain, const job::Limits& limits, const Stopwatch& since,
                    job::Watch& watch) {
  const job::Request& request = run.request;
  job::Triangulated triangulated =
      job::triangulate_domain(request, domain, static_cast<std::int32_t>(run.speeds.size()), job::Cut::kNever, watch);
  end_preparation(run, since, watch);
  const Stopwatch running;
  run.outcome = simulate_on_lattice(request, std::move(triangulated), limits, costs_of(request), run.record, watch);
  run.oracle = run.ideal = ideal_of(run, changing_speeds(request));
  run.record.stages.push_back({"simulate", running.seconds()});
}

/// The remaining work of all ranks together over time.
Json load_json(const ClusterRun& outcome) {
  IdVector<Rank, double> remaining(outcome.ranks.size(), 0);
  double total = 0;
  Json times = Json::array(), loads = Json::array();
  const std::size_t step = std::max<std::size_t>(1, outcome.samples.size() / kRecordedSamples);
  for (std::size_t i = 0; i < outcome.samples.size(); ++i) {
    const LoadSample& s = outcome.samples[i];
    total += s.remaining - std::exchange(remaining[s.rank], s.remaining);
    if (i % step != 0 && i + 1 != outcome.samples.size()) continue;
    times.push_back(s.time);
    loads.push_back(std::round(total));
  }
  return {{"seconds", times}, {"triangles_to_be_made", loads}};
}

Json moves_json(const ClusterRun& outcome) {
  Json moves = Json::array();
  for (const MoveRecord& m : outcome.moves)
    moves.push_back({{"subdomain", m.subdomain},
                     {"from", m.from},
                     {"to", m.to},
                     {"left", m.left},
                     {"arrived", m.arrived},
                     {"bytes", m.bytes}});
  return moves;
}

/// What balancing sees of the subdomains, for `driftmesh replay`.
Json subdomains_json(const ExperimentRun& run) {
  Json x = Json::array(), y = Json::array(), forecast = Json::array(), neighbors = Json::array(),
       borders = Json::array();
  const auto layout = layout_of(run.plan, static_cast<std::int32_t>(run.speeds.size()));
  for (const auto& s : layout->subdomains) {
    x.push_back(s.x);
    y.push_back(s.y);
    forecast.push_back(std::round(s.predicted));
    Json next = Json::array(), lengths = Json::array();
    for (const balancer::Neighbor& n : s.neighbors) {
      next.push_back(n.subdomain);
      lengths.push_back(n.length);
    }
    neighbors.push_back(std::move(next));
    borders.push_back(std::move(lengths));
  }
  return {
      {"x", x}, {"y", y}, {"forecast", forecast}, {"work", run.work}, {"neighbors", neighbors}, {"borders", borders}};
}

}  // namespace

void make_run(ExperimentRun& run, RealCluster* cluster, job::Watch& watch) {
  const job::Request& request = run.request;
  job::cap_memory(request.limits);
  const bool real = request.cluster.kind == job::ClusterKind::kReal;
  if (!real) cluster = nullptr;
  run.speeds = known_speeds(request, cluster);
  const Stopwatch preparing;
  job::Domain domain = job::read_domain(request, {}, watch);
  job::record_domain(run.record, request, domain);
  const job::Limits limits =
      job::find_limits(request.limits, domain.pslg, use_of(request), real ? cluster->processes() : job::Processes{});
  if (!real && request.run.method == job::Method::kPdr)
    run_on_lattice(run, domain, limits, preparing, watch);
  else
    run_in_subdomains(run, cluster, std::move(domain), limits, preparing, watch);
  run.record.seconds = preparing.seconds();
  run.record.seconds_refine = run.outcome.makespan;
}

std::string experiment_record(const ExperimentRun& run) {
  Json record = Json::parse(summary_json(run.record));
  Json swept = Json::object();
  for (const auto& [key, value] : run.swept) swept[key] = config::json_of(value);
  record["format"] = "driftmesh experiment run";
  record["experiment"] = config::json_of(run.request, job::kExperiment);
  record["swept"] = swept;
  record["repetition"] = run.repetition;
  record["cluster"] = {{"seconds", run.outcome.makespan},    {"ideal_seconds", run.ideal},
                       {"oracle_seconds", run.oracle},       {"speeds", run.speeds},
                       {"messages", run.outcome.messages()}, {"message_bytes", run.outcome.message_bytes()},
                       {"owners_before", run.plan.owners},   {"owners_after", run.outcome.owners},
                       {"moves", moves_json(run.outcome)},   {"load", load_json(run.outcome)},
                       {"subdomains", subdomains_json(run)}};
  return json_text(record, 1);
}

}  // namespace driftmesh::app
