#pragma once

#include <memory>

#include "job/place.hpp"
#include "job/rank_run.hpp"
#include "job/team.hpp"

namespace driftmesh::job {

/// The ranks of a team.
class OnRanks : public Place {
 public:
  /// `policies`: equal on all ranks. `logs`: what ranks do is recorded (Refined::history), which takes some time.
  /// The team outlives the place.
  explicit OnRanks(Team& team, balancer::PolicyMaker policies, bool logs = false)
      : team_(team), policies_(std::move(policies)), logs_(logs) {}

  [[nodiscard]] PlaceKind kind() const override { return kRanks; }
  [[nodiscard]] std::int32_t ranks() const override { return team_.ranks(); }
  [[nodiscard]] bool is_team() const override { return true; }
  [[nodiscard]] Processes processes() const override { return processes_of(team_); }
  [[nodiscard]] IdVector<Rank, double> speeds(const Request& request) const override;
  [[nodiscard]] bool leads() const override { return team_.leads(); }
  [[nodiscard]] Order share(const std::function<Order()>& make) override;
  [[nodiscard]] std::unique_ptr<Refined> refine(Order&& order, const Limits& limits, const SizeField* size,
                                                Watch& watch) override;
  void agree(const std::function<void()>& work) override;
  [[nodiscard]] std::vector<StagedFiles::Listed> staged(const StagedFiles& files) override;
  void commit(StagedFiles& files) override;

 protected:
  [[nodiscard]] Team& team() const { return team_; }

 private:
  Team& team_;
  balancer::PolicyMaker policies_;
  bool logs_;
};

}  // namespace driftmesh::job
