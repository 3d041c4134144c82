#include "study/experiment_run.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "balancer/policies/policy_factory.hpp"
#include "base/stopwatch.hpp"
#include "cluster/hindsight.hpp"
#include "config/costs_file.hpp"
#include "config/value_json.hpp"
#include "job/check.hpp"
#include "job/make.hpp"
#include "job/simulated/simulated_ranks.hpp"
#include "runtime/plan_run.hpp"
#include "study/json_text.hpp"
#include "study/pdr/lattice_place.hpp"
#include "study/run_json.hpp"

namespace driftmesh::study {
namespace {

using config::Json;

constexpr std::size_t kRecordedSamples = 200;  // samples of the load over time in a record

/// Triangles per second of real ranks in this run, assuming that all ranks are equally fast without drag.
IdVector<Rank, double> measured_speeds(const ClusterRun& run, IdVector<Rank, double> shares) {
  double seconds = 0;  // time that one rank would have needed for the work
  for (const Rank r : ids_of(shares)) seconds += run.ranks[r].times.computing * shares[r];
  for (double& share : shares) share *= static_cast<double>(run.triangles()) / seconds;
  return shares;
}

CostModel costs_of(const job::Request& request) {
  return request.cluster.costs.empty() ? CostModel{} : config::read_costs(request.cluster.costs);
}

/// Empty if none does.
IdVector<Rank, protocol::SpeedSchedule> changing_speeds(const job::Request& request) {
  if (request.cluster.changes.empty()) return {};
  return schedules_of(job::cluster_of(request));
}

double ideal_of(const ExperimentRun& run, const IdVector<Rank, protocol::SpeedSchedule>& schedules) {
  return schedules.empty() ? ideal_seconds(run.outcome, run.speeds) : ideal_seconds(run.outcome, run.speeds, schedules);
}

std::unique_ptr<job::SimulatedRanks> simulated_ranks(const job::Request& request) {
  const ClusterSpec cluster = job::cluster_of(request);
  const CostModel costs = costs_of(request);
  if (request.run.method == job::Method::kPdr) return std::make_unique<pdr::SimulatedLattice>(cluster, costs);
  return std::make_unique<job::SimulatedRanks>(cluster, costs);
}

/// Where subdomains were moved, how much better they could have been mapped: on a lattice there is nothing to map, and
/// the ideal is that of the oracle, too.
void compare_with_ideal(ExperimentRun& run) {
  const auto schedules = changing_speeds(run.request);
  run.ideal = run.oracle = ideal_of(run, schedules);
  if (run.outcome.owners.empty()) return;
  run.work = work_done(run.outcome, run.speeds, schedules);
  run.oracle = oracle_seconds(run.work, run.speeds, schedules);
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
  const bool real = request.cluster.kind == job::ClusterKind::kReal;
  const Stopwatch running;
  const job::Given given{.policies = balancer::make_policy};
  const auto simulated = real ? nullptr : simulated_ranks(request);
  job::Place& place = real ? cluster->call(request.run.method) : *simulated;
  std::unique_ptr<job::Refined> made = job::make({request, job::kExperiment, given}, place, run.record, watch);
  made->report(run.record);
  run.outcome = made->history();
  if (made->plan() != nullptr) {
    run.plan = *made->plan();
    run.plan.bounds.size = nullptr;
    run.plan.bounds.step = nullptr;
  }
  made.reset();  // the subdomains are no longer needed
  run.speeds = place.speeds(request);
  if (real) run.speeds = measured_speeds(run.outcome, run.speeds);
  compare_with_ideal(run);
  run.record.warnings = watch.take_warnings();
  run.record.stages = watch.take_stages();
  run.record.seconds = running.seconds();
  run.record.seconds_refine = run.outcome.makespan;
}

std::string experiment_record(const ExperimentRun& run) {
  Json record = Json::parse(run_json(run.record));
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

}  // namespace driftmesh::study
