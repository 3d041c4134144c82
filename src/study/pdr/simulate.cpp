#include "study/pdr/simulate.hpp"

#include <memory>
#include <utility>

#include "cluster/simulated/virtual_cluster.hpp"
#include "distributed/observed_exchange.hpp"
#include "driftmesh/error.hpp"
#include "protocol/transport_layer.hpp"
#include "protocol/virtual_network.hpp"
#include "study/pdr/own_cells.hpp"
#include "study/pdr/start.hpp"

namespace driftmesh::pdr {
namespace {

/// Notes the messages of a rank, and the time that they take.
class MeteredTransport final : public protocol::TransportLayer {
 public:
  MeteredTransport(Transport& inner, RankOutcome& outcome) : TransportLayer(inner), outcome_(outcome) {}

  void send(Rank destination, Bytes bytes) override {
    const double begin = now();
    ++outcome_.messages;
    outcome_.message_bytes += bytes.size();
    TransportLayer::send(destination, std::move(bytes));
    outcome_.times.sending += now() - begin;
  }
  std::optional<protocol::Received> poll() override {
    const double begin = now();
    auto message = TransportLayer::poll();
    outcome_.times.polling += now() - begin;
    return message;
  }

 private:
  RankOutcome& outcome_;
};

std::int64_t points_of(const RefineCounters& counters) {
  return counters.free_points + counters.segment_points;
}

/// How many points of a mesh each rank has in its own cells and those that it follows.
IdVector<Rank, std::int64_t> points_near(const Triangulation& mesh, const Lattice& lattice, std::int32_t ranks) {
  IdVector<Rank, std::int64_t> near(to_index(ranks), 0);
  for (const VertexId v : ids_of(mesh.points)) {
    if (mesh.origin[v] == kDeleted || is_input(mesh.origin[v])) continue;
    const Cell cell = lattice.cell_of(mesh.points[v]);
    ++near[lattice.owner_of(cell)];
    for (const Rank r : lattice.followers_of(cell)) ++near[r];
  }
  return near;
}

/// One rank: its part, and its clock.
class SimulatedRank {
 public:
  /// What the rank has just done.
  struct Work {
    double ended, seconds;
    std::int64_t points;  // put into its own cells
  };
  SimulatedRank(protocol::Transport& network, std::unique_ptr<Part> part, const CostModel& costs, double start,
                std::function<void(const Work& work)> worked)
      : transport_(network, outcome_),
        part_(std::move(part)),
        costs_(costs),
        start_(start),
        worked_(std::move(worked)),
        exchange_(part_->refinement, [this](const std::function<void()>& act) { charge(act); }) {}

  protocol::StepResult step() {
    if (start_ > 0) {
      spend(std::exchange(start_, 0), 0);
      return protocol::StepResult::kBusy;
    }
    return runner_.step(exchange_);
  }

  /// What came of it, once it has ended at the time `end`.
  [[nodiscard]] RankOutcome outcome(double end) const {
    RankOutcome outcome = outcome_;
    const auto& traffic = part_->refinement.traffic();
    outcome.counters.splits_sent = traffic.points;
    outcome.counters.batches_sent = traffic.messages;
    outcome.times.idle = end - outcome.times.total();
    return outcome;
  }
  [[nodiscard]] std::unique_ptr<Part> release() { return std::move(part_); }

 private:
  void charge(const std::function<void()>& act) {
    const CellRefiner& cells = part_->refinement.cells();
    const std::int64_t all = points_of(cells.all_counters()), own = points_of(cells.counters());
    act();
    spend(costs_.point * static_cast<double>(points_of(cells.all_counters()) - all), points_of(cells.counters()) - own);
  }
  void spend(double seconds, std::int64_t points) {
    const double begin = transport_.now();
    transport_.spend(seconds);
    const double end = transport_.now();
    outcome_.times.computing += end - begin;
    worked_({end, end - begin, points});
  }

  RankOutcome outcome_;
  MeteredTransport transport_;
  std::unique_ptr<Part> part_;
  const CostModel& costs_;
  double start_;  // seconds of work before the first round
  std::function<void(const Work& work)> worked_;
  ObservedExchange exchange_;
  ExchangeRunner runner_{transport_};
};

}  // namespace

ClusterRun simulate(Triangulation mesh, const QualityBounds& bounds, const ClusterSpec& cluster, const CostModel& costs,
                    const SimulationObservers& observers) {
  const std::int32_t ranks = ranks_of(cluster);
  protocol::VirtualNetwork network(virtual_cluster(cluster, costs));
  const std::size_t input = mesh.live_vertices();
  const Lattice lattice = start(mesh, bounds, ranks);
  const auto started = static_cast<double>(mesh.live_vertices() - input);
  const IdVector<Rank, std::int64_t> near = points_near(mesh, lattice, ranks);
  ClusterRun run;
  auto triangles = static_cast<std::int64_t>(mesh.live_triangles());
  IdVector<Rank, std::unique_ptr<SimulatedRank>> simulated;
  IdVector<Rank, protocol::RankStep> steps;
  for (const Rank r : first_ids<Rank>(ranks)) {
    const auto worked = [&, r](const SimulatedRank::Work& work) {
      triangles += 2 * work.points;
      run.samples.push_back({.time = work.ended, .rank = r, .triangles = triangles, .worked = work.seconds});
      if (observers.progress) observers.progress(triangles);
    };
    const auto close = static_cast<double>(near[r]);
    const double starting = costs.start + costs.point * (close + (started - close) / cluster.scale);
    simulated.push_back(std::make_unique<SimulatedRank>(
        network.transport(r), std::make_unique<Part>(r, ranks, mesh, lattice, bounds), costs, starting, worked));
    steps.push_back([rank = simulated.back().get()] { return rank->step(); });
  }
  if (network.run(steps).end != protocol::RunEnd::kFinished) throw Error("deadlock of the simulated ranks");
  run.makespan = network.makespan();
  for (const Rank r : ids_of(simulated)) {
    RankOutcome outcome = simulated[r]->outcome(network.clock(r));
    const std::unique_ptr<Part> part = simulated[r]->release();
    keep_own_triangles(part->mesh, part->refinement.cells(), lattice, r);
    outcome.triangles = static_cast<std::int64_t>(part->mesh.live_triangles());
    if (observers.finished) observers.finished(*part, r, outcome);
    run.ranks.push_back(outcome);
  }
  return run;
}

}  // namespace driftmesh::pdr
