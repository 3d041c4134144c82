#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "cluster/cluster_spec.hpp"
#include "job/place.hpp"
#include "job/rank_report.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh::job {

/// The ranks of a simulated cluster: the mesh is really made, in virtual time.
class SimulatedRanks : public Place {
 public:
  explicit SimulatedRanks(ClusterSpec cluster, const CostModel& costs = {})
      : cluster_(std::move(cluster)), costs_(costs) {}

  [[nodiscard]] PlaceKind kind() const override { return kSimulated; }
  [[nodiscard]] std::int32_t ranks() const override { return ranks_of(cluster_); }
  /// In triangles per second.
  [[nodiscard]] IdVector<Rank, double> speeds(const Request& /*request*/) const override {
    return speeds_of(cluster_, costs_);
  }
  [[nodiscard]] std::unique_ptr<Refined> refine(Order&& order, const Limits& limits, const SizeField* size,
                                                Watch& watch) override;

 protected:
  [[nodiscard]] const ClusterSpec& cluster() const { return cluster_; }
  [[nodiscard]] const CostModel& costs() const { return costs_; }

 private:
  ClusterSpec cluster_;
  CostModel costs_;
};

/// What is left of a simulated run: what ranks report, and its history. The mesh is gone.
class SimulatedOutcome final : public Refined {
 public:
  SimulatedOutcome(std::vector<RankReport> reports, ClusterRun history, RunPlan plan)
      : reports_(std::move(reports)), history_(std::move(history)), plan_(std::move(plan)) {}

  void report(RunRecord& record) override;
  [[nodiscard]] ClusterRun history() override { return std::move(history_); }
  [[nodiscard]] const RunPlan* plan() const override { return &plan_; }

 private:
  std::vector<RankReport> reports_;
  ClusterRun history_;
  RunPlan plan_;
};

/// An observer of the triangles of all ranks together: shows progress, and throws LimitError if there are more than
/// `limits` allow. The arguments outlive it.
[[nodiscard]] std::function<void(std::int64_t triangles)> progress_within(const Limits& limits, double forecast,
                                                                          Watch& watch);

}  // namespace driftmesh::job
