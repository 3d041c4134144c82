#include "app/experiment_run.hpp"

#include <algorithm>
#include <cmath>

#include "app/json_text.hpp"
#include "app/memory.hpp"
#include "app/rank_report.hpp"
#include "app/summary.hpp"
#include "base/stopwatch.hpp"
#include "cluster/simulate.hpp"
#include "experiment/key_words.hpp"
#include "experiment/prepare.hpp"

namespace driftmesh::app {
namespace {

using experiment::Json;

constexpr std::size_t kRecordedSamples = 200;  // of the load over time, in a record

void record_input(RunRecord& record, const experiment::Experiment& e, const experiment::Prepared& prepared) {
  record.input_file = experiment::input_name(e);
  record.input_points = static_cast<std::int64_t>(prepared.pslg.points.size());
  record.input_segments = static_cast<std::int64_t>(prepared.pslg.segments.size());
  record.input_holes = static_cast<std::int64_t>(prepared.pslg.holes.size());
  record.input_regions = static_cast<std::int64_t>(prepared.pslg.regions.size());
  record.repairs = prepared.repairs;
  record.min_angle = e.angle;
  record.max_area = prepared.plan.bounds.max_area;
  record.sizing = e.size_expression.empty() ? e.size_background : e.size_expression;
  record.acute_corners = prepared.acute_corners;
  record.forecast = prepared.forecast;
}

/// Triangles a second of real ranks in this run: one with the whole of its time is taken to be as fast as any other.
std::vector<double> measured_speeds(const ClusterRun& run, std::vector<double> shares) {
  double seconds = 0;  // that the work would have taken one rank
  for (std::size_t r = 0; r < shares.size(); ++r) seconds += run.ranks[r].times.computing * shares[r];
  for (double& share : shares) share *= static_cast<double>(run.triangles()) / seconds;
  return shares;
}

ClusterRun run_simulated(ExperimentRun& run, const experiment::Prepared& prepared, const RunProgress& progress) {
  SimulationObservers observers;
  observers.progress = [&](std::int64_t triangles) { progress(triangles, prepared.forecast); };
  observers.finished = [&](const RankLoop& rank) { add_report(run.record, report_of(rank, prepared.plan)); };
  ClusterRun outcome = simulate(prepared.plan, experiment::cluster_of(run.experiment), {}, observers);
  add_plan(run.record, prepared.plan);
  run.record.peak = run.record.peak_refining = peak_memory();
  return outcome;
}

/// What is left to do on all ranks together, over time.
Json load_json(const ClusterRun& outcome) {
  std::vector<double> remaining(outcome.ranks.size(), 0);
  double total = 0;
  Json times = Json::array(), loads = Json::array();
  const std::size_t step = std::max<std::size_t>(1, outcome.samples.size() / kRecordedSamples);
  for (std::size_t i = 0; i < outcome.samples.size(); ++i) {
    const LoadSample& s = outcome.samples[i];
    total += s.remaining - std::exchange(remaining[static_cast<std::size_t>(s.rank)], s.remaining);
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

}  // namespace

void make_run(ExperimentRun& run, RealCluster* cluster, const RunProgress& progress) {
  const experiment::Experiment& e = run.experiment;
  const bool real = e.cluster == "real";
  run.speeds = !real            ? speeds_of(experiment::cluster_of(e), {})
               : e.drag.empty() ? std::vector<double>(static_cast<std::size_t>(cluster->ranks()), 1)
                                : e.drag;
  const Stopwatch preparing;
  experiment::Prepared prepared = experiment::prepare(e, run.speeds);
  run.record.stages.push_back({"prepare", preparing.seconds()});
  record_input(run.record, e, prepared);
  const Stopwatch running;
  if (real) {
    run.outcome = cluster->run({prepared.plan, experiment::sizing_of(e), run.speeds}, run.record, progress);
    run.speeds = measured_speeds(run.outcome, run.speeds);
  } else {
    run.outcome = run_simulated(run, prepared, progress);
  }
  run.record.stages.push_back({real ? "run" : "simulate", running.seconds()});
  run.record.seconds = preparing.seconds();
  run.record.seconds_refine = run.outcome.makespan;
  run.plan = std::move(prepared.plan);
  run.plan.bounds.size = nullptr;
}

std::string chrome_trace(const ExperimentRun& run) {
  constexpr double kMicro = 1e6;
  Json events = Json::array();
  for (std::size_t r = 0; r < run.outcome.ranks.size(); ++r)
    events.push_back({{"ph", "M"},
                      {"name", "thread_name"},
                      {"pid", 0},
                      {"tid", r},
                      {"args", {{"name", "rank " + std::to_string(r)}}}});
  for (const LoadSample& s : run.outcome.samples)
    if (s.worked > 0)
      events.push_back({{"ph", "X"},
                        {"name", "refine"},
                        {"pid", 0},
                        {"tid", s.rank},
                        {"ts", kMicro * (s.time - s.worked)},
                        {"dur", kMicro * s.worked},
                        {"args", {{"triangles", s.triangles}, {"to_be_made", s.remaining}}}});
  // A move is two moments, which need a duration to be seen, and an arrow between them.
  for (std::size_t i = 0; i < run.outcome.moves.size(); ++i) {
    const MoveRecord& m = run.outcome.moves[i];
    const std::string name = "subdomain " + std::to_string(m.subdomain);
    for (const bool leaves : {true, false}) {
      const Json at = {{"pid", 0}, {"tid", leaves ? m.from : m.to}, {"ts", kMicro * (leaves ? m.left : m.arrived)}};
      Json moment = {{"ph", "X"}, {"name", name + (leaves ? " leaves" : " arrives")}, {"dur", 1}};
      moment["args"] = {{"bytes", m.bytes}};
      Json arrow = {{"ph", leaves ? "s" : "f"}, {"name", "move"}, {"cat", "move"}, {"id", i}};
      if (!leaves) arrow["bp"] = "e";
      moment.update(at);
      arrow.update(at);
      events.push_back(std::move(moment));
      events.push_back(std::move(arrow));
    }
  }
  return json_text(Json({{"displayTimeUnit", "ms"}, {"traceEvents", std::move(events)}}), -1);
}

std::string experiment_record(const ExperimentRun& run) {
  Json record = Json::parse(summary_json(run.record));
  Json swept = Json::object();
  for (const auto& [key, value] : run.swept) swept[key] = value;
  record["format"] = "driftmesh experiment run";
  record["experiment"] = experiment::experiment_json(run.experiment);
  record["swept"] = swept;
  record["repetition"] = run.repetition;
  record["cluster"] = {{"seconds", run.outcome.makespan},
                       {"ideal_seconds", ideal_seconds(run.outcome, run.speeds)},
                       {"speeds", run.speeds},
                       {"messages", run.outcome.messages()},
                       {"message_bytes", run.outcome.message_bytes()},
                       {"owners_before", run.plan.owners},
                       {"owners_after", run.outcome.owners},
                       {"moves", moves_json(run.outcome)},
                       {"load", load_json(run.outcome)}};
  return json_text(record, 1);
}

}  // namespace driftmesh::app
