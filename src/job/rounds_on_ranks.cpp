#include "job/rounds_on_ranks.hpp"

#include <exception>
#include <utility>
#include <vector>

#include "base/bytes.hpp"
#include "job/domain.hpp"
#include "job/pulse.hpp"
#include "job/rank_report.hpp"
#include "job/same_on_ranks.hpp"
#include "job/thread_run.hpp"
#include "job/with_ranks.hpp"
#include "job/write_on_ranks.hpp"
#include "runtime/plan_run.hpp"

namespace driftmesh::job {
namespace {

class RefinedInRounds final : public Refined {
 public:
  RefinedInRounds(Team& team, Ranks& ranks, std::unique_ptr<ThreadRun> run)
      : team_(team), ranks_(ranks), run_(std::move(run)) {}

  void report(RunRecord& record) override {
    ByteWriter writer;
    by_itself(team_, [&] { run_->rank_report().write(writer); });
    for (const Bytes& bytes : team_.gather(writer.take())) {
      ByteReader reader(bytes);
      add_report(record, RankReport::read(reader));
    }
    record.rounds = run_->rounds();
    record.checkpoints = run_->checkpoints();
    if (team_.leads()) add_plan(record, *run_->plan());
  }

  [[nodiscard]] const RunPlan* plan() const override { return run_->plan(); }

  void write(const Request::Output& files, const Draw& draw, Watch& watch) override {
    const std::vector<Point> holes = run_->holes();
    const DistributedPiece piece = take_piece(watch);
    write_on_ranks(team_, piece, files, holes, draw, watch);
  }

  [[nodiscard]] DistributedPiece take_piece(Watch& watch) override {
    return together(team_, ranks_, [&] { return run_->take_piece(watch); });
  }

  [[nodiscard]] LiveMesh take_live(const Request& request) override { return run_->take_live(request); }

  void save(const Request& request, Watch& watch) override {
    together(team_, ranks_, [&] { run_->save(request, watch); });
  }

 private:
  Team& team_;
  Ranks& ranks_;
  std::unique_ptr<ThreadRun> run_;
};

}  // namespace

IdVector<Rank, double> RoundsOnRanks::speeds(const Request& /*request*/) const {
  return IdVector<Rank, double>(to_index(ranks()), 1.0);
}

Order RoundsOnRanks::share(const std::function<Order()>& make) {
  return OnRanks::share([&] {
    Order order = make();
    order.plan.balancing.policy = "none";  // subdomains stay where they are during a round
    order.plan.policy.reset();
    order.plan.layout.reset();
    return order;
  });
}

/// What all throw together is thrown when nobody waits anymore to hear of others.
void RoundsOnRanks::refine_together(ThreadRun& run, const Request::Patience& patience, Watch& watch) {
  if (team().alone()) return run.refine();
  Pulse pulse(team(), ranks_, patience, forecast_of(*run.plan()), watch, [&run] { return run.left(); });
  std::exception_ptr failure;
  try {
    run.refine(&pulse);
  } catch (const std::exception&) {
    if (!ranks_.have_failed_together()) throw;
    failure = std::current_exception();
  }
  pulse.close();
  if (failure) std::rethrow_exception(failure);
}

std::unique_ptr<Refined> RoundsOnRanks::refine(Order&& order, const Limits& limits, const SizeField* size,
                                               Watch& watch) {
  return together(team(), ranks_, [&] {
    ranks_.agree([&] {
      if (order.size == nullptr) order.size = size_of(order.sizing, order.rasters.open, size, order.pslg).field;
    });
    ranks_.alike([&] {
      if (order.size != nullptr) require_same_size(team(), order.plan.decomposition, *order.size);
    });
    if (order.use.by == kMesh) reuse_memory(order.limits);
    const Request::Patience patience = order.patience;
    auto run = std::make_unique<ThreadRun>(std::move(order), limits, threads_, watch, &ranks_);
    refine_together(*run, patience, watch);
    return std::make_unique<RefinedInRounds>(team(), ranks_, std::move(run));
  });
}

}  // namespace driftmesh::job
