#include "study/pdr/lattice_place.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "cluster/simulated/virtual_cluster.hpp"
#include "driftmesh/error.hpp"
#include "job/drag.hpp"
#include "job/failure.hpp"
#include "job/memory.hpp"
#include "job/rank_report.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "mesh/forecast.hpp"
#include "protocol/transport_layer.hpp"
#include "protocol/virtual_network.hpp"
#include "study/pdr/part.hpp"

namespace driftmesh::pdr {
namespace {

/// A rank that refines its part, in real or virtual time, and what it spends its time on.
class LatticeRank final : private protocol::TransportLayer {
 public:
  struct Work {
    double seconds = 0;                // real ones
    std::int64_t points = 0, own = 0;  // inserted, and inserted in the rank's own cells
  };
  /// `worked` is called after each piece of work; the time that it lets pass belongs to that work.
  LatticeRank(protocol::Transport& network, Triangulation started, const Lattice& lattice, const QualityBounds& bounds,
              std::function<void(const Work&)> worked)
      : TransportLayer(network),
        worked_(std::move(worked)),
        part_(network.rank(), network.ranks(), std::move(started), lattice, bounds, [this] { charge_work(); }),
        clock_(network.now()) {}

  [[nodiscard]] const Triangulation& mesh() const { return part_.mesh(); }
  [[nodiscard]] protocol::StepResult step() {
    charge(&RankTimes::idle);  // it has waited for this step
    return runner_.step(part_);
  }

  /// At the end.
  [[nodiscard]] job::RankReport report(const QualityBounds& bounds) {
    job::RankReport report{{outcome_}, part_.keep_own(bounds)};
    report.rank.triangles = report.facts.triangles;
    report.rank.counters.splits_sent = part_.told();
    report.rank.counters.batches_sent = static_cast<std::int64_t>(outcome_.messages);
    return report;
  }

 private:
  void send(Rank destination, Bytes bytes) override {
    ++outcome_.messages;
    outcome_.message_bytes += bytes.size();
    TransportLayer::send(destination, std::move(bytes));
    charge(&RankTimes::sending);
  }
  std::optional<protocol::Received> poll() override {
    auto message = TransportLayer::poll();
    charge(message ? &RankTimes::polling : &RankTimes::idle);
    return message;
  }

  void charge_work() {
    const std::int64_t points = points_of(part_.cells().counters()), own = points_of(part_.cells().own_counters());
    worked_({now() - clock_, points - std::exchange(so_far_.points, points), own - std::exchange(so_far_.own, own)});
    charge(&RankTimes::computing);
  }
  /// Adds the time since the last call to one category.
  void charge(double RankTimes::*kind) {
    const double time = now();
    outcome_.times.*kind += time - std::exchange(clock_, time);
  }
  static std::int64_t points_of(const RefineCounters& counters) {
    return counters.free_points + counters.segment_points;
  }

  std::function<void(const Work&)> worked_;
  Part part_;
  ExchangeRunner runner_{*this};
  RankOutcome outcome_;
  double clock_;  // when time was last charged
  Work so_far_;
};

using LatticeRanks = std::vector<std::unique_ptr<LatticeRank>>;

/// The ranks of this process, refined. With a team, the ranks of others report, too.
class RefinedLattice final : public job::Refined {
 public:
  RefinedLattice(LatticeRanks ranks, const QualityBounds& bounds, job::Team* team, ClusterRun run)
      : ranks_(std::move(ranks)), bounds_(bounds), team_(team), run_(std::move(run)) {}

  void report(job::RunRecord& record) override {
    for (const Bytes& bytes : all_reports())
      for (ByteReader reader(bytes); !reader.at_end();) {
        const job::RankReport report = job::RankReport::read(reader);
        job::add_report(record, report);
        run_.ranks.push_back(report.rank);
        run_.makespan = std::max(run_.makespan, report.rank.times.total());
      }
    record.peak = record.peak_refining = std::max(record.peak, job::peak_memory());
  }
  [[nodiscard]] ClusterRun history() override { return std::move(run_); }
  [[nodiscard]] const RunPlan* plan() const override { return nullptr; }

 private:
  /// Of each process.
  [[nodiscard]] std::vector<Bytes> all_reports() {
    if (team_ == nullptr) return {own_reports()};
    return team_->gather(job::by_itself(*team_, [&] { return own_reports(); }));
  }
  [[nodiscard]] Bytes own_reports() {
    ByteWriter writer;
    for (const auto& rank : ranks_) {
      job::RankReport report = rank->report(bounds_);
      report.rank.peak = team_ == nullptr ? 0 : job::peak_memory();
      report.write(writer);
    }
    return writer.take();
  }

  LatticeRanks ranks_;
  QualityBounds bounds_;
  job::Team* team_;
  ClusterRun run_;
};

/// How many points of a mesh each rank has in its own cells and those that it follows.
IdVector<Rank, double> points_near(const Triangulation& mesh, const Lattice& lattice, std::int32_t ranks) {
  std::map<Cell, double> points;
  for (const VertexId v : ids_of(mesh.points))
    if (mesh.origin[v] != kDeleted && !is_input(mesh.origin[v])) ++points[lattice.cell_of(mesh.points[v])];
  IdVector<Rank, double> near(to_index(ranks), 0);
  for (const auto& [cell, count] : points) {
    near[lattice.owner_of(cell)] += count;
    for (const Rank r : lattice.followers_of(cell)) near[r] += count;
  }
  return near;
}

}  // namespace

std::unique_ptr<job::Refined> LatticeOnRanks::refine(job::Order&& order, const job::Limits& limits,
                                                     const SizeField* /*size*/, job::Watch& watch) {
  const QualityBounds& bounds = order.plan.bounds;
  const double share = order.shares.empty() ? 1 : order.shares[team().rank()];
  Triangulation mesh;
  std::optional<Lattice> lattice;
  double forecast = 0;
  job::agree(team(), [&] {
    mesh = triangulate(order.pslg);
    static_cast<void>(prepare_corners(mesh, {bounds.min_angle, false}));
    forecast = forecast_triangles(mesh, bounds);
    lattice.emplace(start(mesh, bounds, ranks()));
  });
  const std::unique_ptr<job::Channel> channel = team().open();  // and closed, since nobody fails alone from here on
  LatticeRanks own;
  job::by_itself(team(), [&] {
    const auto check = job::progress_within(limits, forecast / ranks(), watch);
    const auto worked = [&own, share, check](const LatticeRank::Work& work) {
      job::drag(share, work.seconds);
      check(static_cast<std::int64_t>(own.front()->mesh().live_triangles()));
    };
    own.push_back(std::make_unique<LatticeRank>(channel->transport(), std::move(mesh), *lattice, bounds, worked));
    protocol::run_rank(channel->transport(), [&] { return own.front()->step(); });
  });
  channel->close();
  return std::make_unique<RefinedLattice>(std::move(own), bounds, &team(), ClusterRun{});
}

std::unique_ptr<job::Refined> SimulatedLattice::refine(job::Order&& order, const job::Limits& limits,
                                                       const SizeField* /*size*/, job::Watch& watch) {
  job::Triangulated& whole = order.whole->triangulated;
  const auto progress = job::progress_within(limits, whole.forecast, watch);
  protocol::VirtualNetwork network(virtual_cluster(cluster(), costs()));
  const std::size_t input = whole.mesh.live_vertices();
  const Lattice lattice = start(whole.mesh, whole.bounds, ranks());
  const auto started = static_cast<double>(whole.mesh.live_vertices() - input);
  const IdVector<Rank, double> near = points_near(whole.mesh, lattice, ranks());
  ClusterRun run;
  auto triangles = static_cast<std::int64_t>(whole.mesh.live_triangles());
  LatticeRanks at_work;
  IdVector<Rank, protocol::RankStep> steps;
  for (const Rank r : first_ids<Rank>(ranks())) {
    const double starting = costs().start + costs().point * (near[r] + (started - near[r]) / cluster().scale);
    const auto worked = [&, r, left = starting](const LatticeRank::Work& work) mutable {
      protocol::Transport& clock = network.transport(r);
      const double begin = clock.now();
      clock.spend(std::exchange(left, 0) + costs().point * static_cast<double>(work.points));
      triangles += 2 * work.own;
      run.samples.push_back({.time = clock.now(), .rank = r, .triangles = triangles, .worked = clock.now() - begin});
      progress(triangles);
    };
    at_work.push_back(std::make_unique<LatticeRank>(network.transport(r), whole.mesh, lattice, whole.bounds, worked));
    steps.push_back([rank = at_work.back().get()] { return rank->step(); });
  }
  if (network.run(steps).end != protocol::RunEnd::kFinished) throw Error("deadlock of the simulated ranks");
  run.makespan = network.makespan();
  return std::make_unique<RefinedLattice>(std::move(at_work), whole.bounds, nullptr, std::move(run));
}

}  // namespace driftmesh::pdr
