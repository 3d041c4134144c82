#include "app/lattice_place.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/bytes.hpp"
#include "base/stopwatch.hpp"
#include "distributed/observed_exchange.hpp"
#include "driftmesh/error.hpp"
#include "job/failure.hpp"
#include "job/limits.hpp"
#include "job/memory.hpp"
#include "job/rank_report.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
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

/// The outcome of a real rank that refined for `seconds`, and waited when it did not compute.
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

/// What is known on all ranks, or on the only process, of a mesh on a lattice.
struct LatticeFacts {
  double max_area = 0;
  double forecast = 0;
  std::int32_t acute_corners = 0;
  std::int64_t vertices = 0, subsegments = 0;
};

class RefinedOnLattice final : public job::Refined {
 public:
  RefinedOnLattice(std::vector<job::RankReport> reports, ClusterRun history, const LatticeFacts& facts)
      : reports_(std::move(reports)), history_(std::move(history)), facts_(facts) {}

  void report(job::RunRecord& record) override {
    record.max_area = facts_.max_area;
    record.forecast = facts_.forecast;
    record.acute_corners = facts_.acute_corners;
    for (const job::RankReport& rank : reports_) job::add_report(record, rank);
    record.vertices = facts_.vertices;
    record.subsegments = facts_.subsegments;
    record.peak = record.peak_refining = std::max(record.peak, job::peak_memory());
  }
  [[nodiscard]] ClusterRun history() override { return std::move(history_); }
  [[nodiscard]] const RunPlan* plan() const override { return nullptr; }

 private:
  std::vector<job::RankReport> reports_;
  ClusterRun history_;
  LatticeFacts facts_;
};

Bytes bytes_of(const job::Order& order) {
  const job::Whole& whole = *order.whole;
  const QualityBounds& bounds = whole.triangulated.bounds;
  ByteWriter writer;
  writer.value(order.limits);
  writer.value(order.use);
  writer.value(bounds.min_angle);
  writer.value(bounds.max_area);
  writer.array(bounds.region_max_area);
  writer.value(whole.triangulated.forecast);
  return writer.take();
}

job::Order order_of(const Bytes& bytes, const Bytes& pslg) {
  job::Order order;
  job::Whole& whole = order.whole.emplace();
  QualityBounds& bounds = whole.triangulated.bounds;
  ByteReader reader(bytes);
  reader.value(order.limits);
  reader.value(order.use);
  reader.value(bounds.min_angle);
  reader.value(bounds.max_area);
  reader.array(bounds.region_max_area);
  reader.value(whole.triangulated.forecast);
  whole.domain.pslg = pslg_from_bytes(pslg);
  return order;
}

/// This rank's share of the refinement. `check` is called with its triangles from time to time.
RankOutcome refine_part(pdr::Part& part, job::Team& team, const std::function<void(std::int64_t)>& check) {
  const std::unique_ptr<job::Channel> channel = team.open();
  double computing = 0;
  const Stopwatch refining;
  job::by_itself(team, [&] {
    ExchangeRunner ranks(channel->transport());
    ObservedExchange refinement(part.refinement, [&](const std::function<void()>& act) {
      const Stopwatch working;
      act();
      computing += working.seconds();
      check(static_cast<std::int64_t>(part.mesh.live_triangles()));
    });
    ranks.run(refinement);
  });
  const double seconds = refining.seconds();
  channel->close();
  return outcome_of(part, computing, seconds);
}

/// What rank 0 knows at the end, from the report of each rank with the vertices and subsegments that it has.
struct Gathered {
  std::vector<job::RankReport> reports;
  ClusterRun history;
  std::int64_t vertices = 0, subsegments = 0;

  void add(const Bytes& bytes) {
    ByteReader reader(bytes);
    const job::RankReport& report = reports.emplace_back(job::RankReport::read(reader));
    vertices += reader.value<std::int64_t>();
    subsegments += reader.value<std::int64_t>();
    history.ranks.push_back(report.rank);
    history.makespan = std::max(history.makespan, report.rank.times.total());
  }
};

Bytes report_bytes(pdr::Part& part, const QualityBounds& bounds, Rank rank, const RankOutcome& outcome) {
  pdr::keep_own_triangles(part.mesh, part.refinement.cells(), part.lattice, rank);
  const pdr::OwnCounts own = pdr::count_own(part.mesh, part.lattice, rank);
  job::RankReport report = report_of(part, bounds, outcome);
  report.rank.peak = job::peak_memory();
  ByteWriter writer;
  report.write(writer);
  writer.value(own.vertices);
  writer.value(own.subsegments);
  return writer.take();
}

}  // namespace

job::Order LatticeOnRanks::share(const std::function<job::Order()>& make) {
  job::Order order;
  agree([&] {
    if (!leads()) return;
    order = make();
    require_area_bound(order.whole->triangulated.bounds);
  });
  const Bytes head = team().broadcast(leads() ? bytes_of(order) : Bytes());
  const Bytes pslg = team().broadcast(leads() ? pslg_to_bytes(order.whole->domain.pslg) : Bytes());
  if (!leads()) order = order_of(head, pslg);
  job::cap_memory(order.limits);
  return order;
}

std::unique_ptr<job::Refined> LatticeOnRanks::refine(job::Order&& order, const job::Limits& limits,
                                                     const SizeField* /*size*/, job::Watch& watch) {
  const job::Whole& whole = *order.whole;
  const QualityBounds& bounds = whole.triangulated.bounds;
  LatticeFacts facts{.max_area = bounds.max_area, .forecast = whole.triangulated.forecast};
  std::unique_ptr<pdr::Part> part;
  agree([&] {
    Triangulation mesh = triangulate(whole.domain.pslg);
    facts.acute_corners = prepare_corners(mesh, {bounds.min_angle, false});
    const pdr::Lattice lattice = pdr::start(mesh, bounds, ranks());
    part = std::make_unique<pdr::Part>(team().rank(), ranks(), std::move(mesh), lattice, bounds);
  });
  const RankOutcome outcome = refine_part(*part, team(), job::progress_within(limits, facts.forecast / ranks(), watch));
  Gathered all;
  for (const Bytes& bytes : team().gather(report_bytes(*part, bounds, team().rank(), outcome))) all.add(bytes);
  facts.vertices = all.vertices;
  facts.subsegments = all.subsegments;
  return std::make_unique<RefinedOnLattice>(std::move(all.reports), std::move(all.history), facts);
}

std::unique_ptr<job::Refined> SimulatedLattice::refine(job::Order&& order, const job::Limits& limits,
                                                       const SizeField* /*size*/, job::Watch& watch) {
  job::Triangulated& triangulated = order.whole->triangulated;
  const QualityBounds& bounds = triangulated.bounds;
  require_area_bound(bounds);
  LatticeFacts facts{
      .max_area = bounds.max_area, .forecast = triangulated.forecast, .acute_corners = triangulated.acute_corners};
  std::vector<job::RankReport> reports;
  pdr::SimulationObservers observers;
  observers.progress = job::progress_within(limits, triangulated.forecast, watch);
  observers.finished = [&](const pdr::Part& part, Rank rank, const RankOutcome& outcome) {
    reports.push_back(report_of(part, bounds, outcome));
    const pdr::OwnCounts own = pdr::count_own(part.mesh, part.lattice, rank);
    facts.vertices += own.vertices;
    facts.subsegments += own.subsegments;
  };
  ClusterRun history = pdr::simulate(std::move(triangulated.mesh), bounds, cluster(), costs(), observers);
  return std::make_unique<RefinedOnLattice>(std::move(reports), std::move(history), facts);
}

}  // namespace driftmesh::app
