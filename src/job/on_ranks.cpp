#include "job/on_ranks.hpp"

#include <utility>

#include "base/bytes.hpp"
#include "distributed/exchange.hpp"
#include "job/check.hpp"
#include "job/failure.hpp"
#include "job/outputs.hpp"
#include "job/rank_report.hpp"
#include "job/write_on_ranks.hpp"

namespace driftmesh::job {
namespace {

class RefinedOnRanks final : public Refined {
 public:
  RefinedOnRanks(Team& team, Order&& order, const Limits& limits, const SizeField* size, bool logs, Watch& watch)
      : team_(team), logs_(logs), run_(std::in_place, team, std::move(order), limits, size, watch) {
    run_->refine(logs);
  }

  void report(RunRecord& record) override {
    ByteWriter writer;
    by_itself(team_, [&] {
      run_->report().write(writer);
      if (logs_) run_->log().write(writer);
    });
    IdVector<Rank, RankLog> logs;
    for (const Bytes& bytes : team_.gather(writer.take())) {
      ByteReader reader(bytes);
      add_report(record, RankReport::read(reader));
      if (logs_) logs.push_back(RankLog::read(reader));
    }
    if (!team_.leads()) return;
    add_plan(record, run_->plan());
    if (logs_) history_ = RankLog::join(logs);
  }

  [[nodiscard]] ClusterRun history() override { return std::move(history_); }
  [[nodiscard]] const RunPlan* plan() const override { return &run_->plan(); }

  void write(const Request::Output& files, const Draw& draw, Watch& watch) override {
    const std::vector<Point> holes = run_->holes();
    const DistributedPiece piece = take_piece(watch);
    write_on_ranks(team_, piece, files, holes, draw, watch);
  }

  [[nodiscard]] DistributedPiece take_piece(Watch& watch) override {
    DistributedPiece piece;
    exchange_on(team_,
                [&](ExchangeRunner& ranks) { timed(watch, "assemble", [&] { piece = run_->assemble(ranks); }); });
    run_.reset();
    return piece;
  }

 private:
  Team& team_;
  bool logs_;
  std::optional<RankRun> run_;
  ClusterRun history_;
};

}  // namespace

IdVector<Rank, double> OnRanks::speeds(const Request& request) const {
  return shares_of_time(request, ranks());
}

Order OnRanks::share(const std::function<Order()>& make) {
  Order order = job::share(team_, make, policies_);
  if (order.use.by != kLibrary) cap_memory(order.limits);
  return order;
}

std::unique_ptr<Refined> OnRanks::refine(Order&& order, const Limits& limits, const SizeField* size, Watch& watch) {
  if (order.use.by == kMesh) reuse_memory(order.limits);
  return std::make_unique<RefinedOnRanks>(team_, std::move(order), limits, size, logs_, watch);
}

void OnRanks::agree(const std::function<void()>& work) {
  job::agree(team_, work);
}

std::vector<StagedFiles::Listed> OnRanks::staged(const StagedFiles& files) {
  return staged_by_all(team_, files);
}

void OnRanks::commit(StagedFiles& files) {
  job::commit(team_, files);
}

}  // namespace driftmesh::job
