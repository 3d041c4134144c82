#include "app/lattice_run.hpp"

#include <functional>
#include <memory>
#include <utility>

#include "base/stopwatch.hpp"
#include "distributed/observed_exchange.hpp"
#include "driftmesh/error.hpp"
#include "job/check.hpp"
#include "job/domain.hpp"
#include "job/failure.hpp"
#include "job/memory.hpp"
#include "job/rank_report.hpp"
#include "job/simulated/run_simulated.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "pdr/cell_assembly.hpp"
#include "pdr/own_cells.hpp"
#include "pdr/part.hpp"
#include "pdr/simulated/simulate.hpp"
#include "pdr/start.hpp"
#include "runtime/plan_bytes.hpp"

namespace driftmesh::app {
namespace {

using job::timed;

/// `part` has only the triangles of its own cells.
job::RankReport report_of(const pdr::Part& part, const QualityBounds& bounds, const RankOutcome& outcome) {
  job::RankReport report;
  job::add_part(report.facts, part.mesh, bounds, true);
  job::add_counters(report.facts, part.refinement.cells().counters());
  static_cast<RankOutcome&>(report.rank) = outcome;
  report.rank.triangles = report.facts.triangles;
  return report;
}

/// Of a real rank that refined for `seconds`, and waited when it did not compute.
RankOutcome outcome_of(const pdr::Part& part, double computing, double seconds) {
  RankOutcome outcome;
  outcome.times.computing = computing;
  outcome.times.idle = seconds - computing;
  const auto& traffic = part.refinement.traffic();
  outcome.counters.splits_sent = traffic.points;
  outcome.counters.batches_sent = traffic.messages;
  outcome.messages = static_cast<std::uint64_t>(traffic.messages);
  outcome.message_bytes = static_cast<std::uint64_t>(traffic.bytes);
  return outcome;
}

void require_area_bound(const QualityBounds& bounds) {
  if (!(bounds.max_area > 0))
    throw job::KeyError("run.method", "is pdr, but nothing bounds the size of triangles",
                        "give bounds.area or bounds.triangles, or use the coupled method");
}

}  // namespace

BoundedDomain share_domain(const job::Request& request, const job::Use& use, job::Team& team, RunNotes& notes) {
  Pslg pslg;
  ByteWriter area;
  job::agree(team, [&] {
    if (!team.leads()) return;
    job::Domain domain = job::read_domain(request, {}, notes);
    job::record_domain(notes.run, request, domain);
    const job::Triangulated found = job::triangulate_domain(request, domain, team.ranks(), job::Cut::kNever, notes);
    require_area_bound(found.bounds);
    job::check_forecast(job::find_limits(request.limits, domain.pslg, use, job::processes_of(team)), found.forecast,
                        false, [&] { return find_narrow_place(found.mesh); });
    notes.run.forecast = found.forecast;
    area.number(found.bounds.max_area);
    pslg = std::move(domain.pslg);
    pslg.holes = found.holes;
  });
  pslg = pslg_from_bytes(team.broadcast(team.leads() ? pslg_to_bytes(pslg) : Bytes()));
  const Bytes bytes = team.broadcast(area.take());
  notes.run.max_area = ByteReader(bytes).number<double>();
  QualityBounds bounds = bounds_of(
      pslg,
      {.min_angle = request.bounds.angle, .max_area = notes.run.max_area, .region_areas = request.bounds.region_areas});
  return {std::move(pslg), std::move(bounds)};
}

DistributedPiece mesh_on_lattice(job::Team& team, const BoundedDomain& domain, RunNotes& notes) {
  const Pslg& pslg = domain.pslg;
  const QualityBounds& bounds = domain.bounds;
  const std::unique_ptr<job::Channel> channel = team.open();
  DistributedPiece piece;
  std::int64_t subsegments = 0;
  job::by_itself(team, [&] {
    ExchangeRunner ranks(channel->transport());
    Triangulation mesh = triangulate(pslg);
    notes.run.acute_corners = prepare_corners(mesh, {bounds.min_angle, false});
    const auto part = timed(notes, "start", [&] {
      const pdr::Lattice lattice = pdr::start(mesh, bounds, team.ranks());
      return std::make_unique<pdr::Part>(team.rank(), team.ranks(), std::move(mesh), lattice, bounds);
    });
    double computing = 0;
    ObservedExchange refinement(part->refinement, [&](const std::function<void()>& act) {
      const Stopwatch working;
      act();
      computing += working.seconds();
    });
    const Stopwatch refining;
    timed(notes, "refine", [&] { ranks.run(refinement); });
    const RankOutcome outcome = outcome_of(*part, computing, refining.seconds());
    timed(notes, "assemble", [&] {
      pdr::CellAssembly assembly(team.rank(), team.ranks(), part->mesh, part->refinement.cells(), part->lattice);
      ranks.run(assembly);
      piece = assembly.piece(pslg);
      subsegments = assembly.total_subsegments();
    });
    pdr::keep_own_triangles(part->mesh, part->refinement.cells(), part->lattice, team.rank());
    job::RankReport report = report_of(*part, bounds, outcome);
    report.rank.peak = job::peak_memory();
    job::gather_reports(team, report, notes.run);
  });
  channel->close();
  notes.run.vertices = piece.total_points;
  notes.run.subsegments = subsegments;
  return piece;
}

ClusterRun simulate_on_lattice(const job::Request& request, job::Triangulated&& triangulated, const job::Limits& limits,
                               const CostModel& costs, job::RunRecord& record, job::Watch& watch) {
  const QualityBounds& bounds = triangulated.bounds;
  require_area_bound(bounds);
  record.acute_corners = triangulated.acute_corners;
  record.forecast = triangulated.forecast;
  record.max_area = bounds.max_area;
  pdr::SimulationObservers observers;
  observers.progress = job::progress_within(limits, triangulated.forecast, watch);
  std::int64_t vertices = 0, subsegments = 0;
  observers.finished = [&](const pdr::Part& part, Rank rank, const RankOutcome& outcome) {
    job::add_report(record, report_of(part, bounds, outcome));
    const pdr::OwnCounts own = pdr::count_own(part.mesh, part.lattice, rank);
    vertices += own.vertices;
    subsegments += own.subsegments;
  };
  ClusterRun run = pdr::simulate(std::move(triangulated.mesh), bounds, job::cluster_of(request), costs, observers);
  record.vertices = vertices;
  record.subsegments = subsegments;
  record.peak = record.peak_refining = job::peak_memory();
  return run;
}

}  // namespace driftmesh::app
