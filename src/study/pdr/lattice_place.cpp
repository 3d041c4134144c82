#include "study/pdr/lattice_place.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/bytes.hpp"
#include "base/stopwatch.hpp"
#include "distributed/observed_exchange.hpp"
#include "driftmesh/error.hpp"
#include "job/drag.hpp"
#include "job/failure.hpp"
#include "job/limits.hpp"
#include "job/memory.hpp"
#include "job/rank_report.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "runtime/plan_bytes.hpp"
#include "study/pdr/own_cells.hpp"
#include "study/pdr/part.hpp"
#include "study/pdr/simulate.hpp"
#include "study/pdr/start.hpp"

namespace driftmesh::pdr {
namespace {

using job::timed;

/// `part` has only the triangles of its own cells.
job::RankReport report_of(const Part& part, const QualityBounds& bounds, const RankOutcome& outcome) {
  job::RankReport report;
  job::add_part(report.facts, part.mesh, bounds, true);
  job::add_counters(report.facts, part.refinement.cells().counters());
  static_cast<RankOutcome&>(report.rank) = outcome;
  report.rank.triangles = report.facts.triangles;
  return report;
}

/// The outcome of a real rank that refined for `seconds`, and waited when it did not compute.
RankOutcome outcome_of(const Part& part, double computing, double seconds) {
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

/// What is known of the whole mesh.
struct LatticeFacts {
  double max_area = 0;
  double forecast = 0;
  std::int32_t acute_corners = 0;
  std::int64_t vertices = 0, subsegments = 0;

  void write_to(job::RunRecord& record) const {
    record.max_area = max_area;
    record.forecast = forecast;
    record.acute_corners = acute_corners;
    record.vertices = vertices;
    record.subsegments = subsegments;
    record.peak = record.peak_refining = std::max(record.peak, job::peak_memory());
  }
};

/// What is left of a simulated run. The mesh is gone.
class SimulatedOutcome final : public job::Refined {
 public:
  SimulatedOutcome(std::vector<job::RankReport> reports, ClusterRun history, const LatticeFacts& facts)
      : reports_(std::move(reports)), history_(std::move(history)), facts_(facts) {}

  void report(job::RunRecord& record) override {
    for (const job::RankReport& rank : reports_) job::add_report(record, rank);
    facts_.write_to(record);
  }
  [[nodiscard]] ClusterRun history() override { return std::move(history_); }
  [[nodiscard]] const RunPlan* plan() const override { return nullptr; }

 private:
  std::vector<job::RankReport> reports_;
  ClusterRun history_;
  LatticeFacts facts_;
};

/// The fields in one order for both directions: `stream` is a ByteWriter with a const order, or a ByteReader.
template <class Stream, class Order>
void transfer(Stream& stream, Order& order) {
  auto& triangulated = order.whole->triangulated;
  stream.value(order.limits);
  stream.value(order.use);
  stream.array(order.shares);
  stream.value(triangulated.bounds.min_angle);
  stream.value(triangulated.bounds.max_area);
  stream.array(triangulated.bounds.region_max_area);
  stream.value(triangulated.forecast);
}

Bytes bytes_of(const job::Order& order) {
  ByteWriter writer;
  transfer(writer, order);
  return writer.take();
}

job::Order order_of(const Bytes& bytes, const Bytes& pslg) {
  job::Order order;
  order.whole.emplace().domain.pslg = pslg_from_bytes(pslg);
  ByteReader reader(bytes);
  transfer(reader, order);
  return order;
}

/// This rank's share of the refinement, with this share of its time. `check` is called with the triangles that the rank
/// has of its own and around them, from time to time.
RankOutcome refine_part(Part& part, job::Team& team, double share, const std::function<void(std::int64_t)>& check) {
  const std::unique_ptr<job::Channel> channel = team.open();
  double computing = 0;
  const Stopwatch refining;
  job::by_itself(team, [&] {
    ExchangeRunner ranks(channel->transport());
    ObservedExchange refinement(part.refinement, [&](const std::function<void()>& act) {
      const Stopwatch working;
      act();
      job::drag(share, working.seconds());
      computing += working.seconds();
      check(static_cast<std::int64_t>(part.mesh.live_triangles()));
    });
    ranks.run(refinement);
  });
  const double seconds = refining.seconds();
  channel->close();
  return outcome_of(part, computing, seconds);
}

/// A rank's part, refined.
class RefinedPart final : public job::Refined {
 public:
  RefinedPart(job::Team& team, job::Order&& order, const job::Limits& limits, job::Watch& watch)
      : team_(team), order_(std::move(order)) {
    facts_ = {.max_area = bounds().max_area, .forecast = order_.whole->triangulated.forecast};
    const double share = order_.shares.empty() ? 1 : order_.shares[team.rank()];
    job::agree(team, [&] {
      Triangulation mesh = triangulate(order_.whole->domain.pslg);
      facts_.acute_corners = prepare_corners(mesh, {bounds().min_angle, false});
      const Lattice lattice = start(mesh, bounds(), team.ranks());
      part_ = std::make_unique<Part>(team.rank(), team.ranks(), std::move(mesh), lattice, bounds());
    });
    outcome_ = refine_part(*part_, team, share, job::progress_within(limits, facts_.forecast, watch));
  }

  void report(job::RunRecord& record) override {
    const Bytes own = job::by_itself(team_, [&] { return own_report(); });
    for (const Bytes& bytes : team_.gather(own)) {
      ByteReader reader(bytes);
      const job::RankReport report = job::RankReport::read(reader);
      facts_.vertices += reader.value<std::int64_t>();
      facts_.subsegments += reader.value<std::int64_t>();
      job::add_report(record, report);
      history_.ranks.push_back(report.rank);
      history_.makespan = std::max(history_.makespan, report.rank.times.total());
    }
    facts_.write_to(record);
  }
  [[nodiscard]] ClusterRun history() override { return std::move(history_); }
  [[nodiscard]] const RunPlan* plan() const override { return nullptr; }

 private:
  [[nodiscard]] const QualityBounds& bounds() const { return order_.whole->triangulated.bounds; }

  [[nodiscard]] Bytes own_report() {
    keep_own_triangles(part_->mesh, part_->refinement.cells(), part_->lattice, team_.rank());
    const OwnCounts own = count_own(part_->mesh, part_->lattice, team_.rank());
    job::RankReport report = report_of(*part_, bounds(), outcome_);
    report.rank.peak = job::peak_memory();
    ByteWriter writer;
    report.write(writer);
    writer.value(own.vertices);
    writer.value(own.subsegments);
    return writer.take();
  }

  job::Team& team_;
  job::Order order_;
  LatticeFacts facts_;
  std::unique_ptr<Part> part_;
  RankOutcome outcome_;
  ClusterRun history_;
};

}  // namespace

job::Order LatticeOnRanks::share(const std::function<job::Order()>& make) {
  job::Order order;
  agree([&] {
    if (!leads()) return;
    order = make();
    require_area_bound(order.whole->triangulated.bounds);
  });
  Bytes head, pslg;
  job::by_itself(team(), [&] {
    if (!leads()) return;
    head = bytes_of(order);
    pslg = pslg_to_bytes(order.whole->domain.pslg);
  });
  head = team().broadcast(std::move(head));
  pslg = team().broadcast(std::move(pslg));
  agree([&] {
    if (!leads()) order = order_of(head, pslg);
  });
  job::cap_memory(order.limits);
  return order;
}

std::unique_ptr<job::Refined> LatticeOnRanks::refine(job::Order&& order, const job::Limits& limits,
                                                     const SizeField* /*size*/, job::Watch& watch) {
  return std::make_unique<RefinedPart>(team(), std::move(order), limits, watch);
}

std::unique_ptr<job::Refined> SimulatedLattice::refine(job::Order&& order, const job::Limits& limits,
                                                       const SizeField* /*size*/, job::Watch& watch) {
  job::Triangulated& triangulated = order.whole->triangulated;
  const QualityBounds& bounds = triangulated.bounds;
  require_area_bound(bounds);
  LatticeFacts facts{
      .max_area = bounds.max_area, .forecast = triangulated.forecast, .acute_corners = triangulated.acute_corners};
  std::vector<job::RankReport> reports;
  SimulationObservers observers;
  observers.progress = job::progress_within(limits, triangulated.forecast, watch);
  observers.finished = [&](const Part& part, Rank rank, const RankOutcome& outcome) {
    reports.push_back(report_of(part, bounds, outcome));
    const OwnCounts own = count_own(part.mesh, part.lattice, rank);
    facts.vertices += own.vertices;
    facts.subsegments += own.subsegments;
  };
  ClusterRun history = simulate(std::move(triangulated.mesh), bounds, cluster(), costs(), observers);
  return std::make_unique<SimulatedOutcome>(std::move(reports), std::move(history), facts);
}

}  // namespace driftmesh::pdr
