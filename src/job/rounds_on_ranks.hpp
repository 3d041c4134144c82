#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "distributed/ranks.hpp"
#include "job/place.hpp"
#include "job/team.hpp"

namespace driftmesh::job {

/// The ranks of a team that refine in rounds: the mesh is the one that a process makes in subdomains by itself,
/// whatever the number of ranks.
class RoundsOnRanks final : public Place {
 public:
  /// `ranks`: those of the team. Each works with this many threads.
  RoundsOnRanks(Team& team, Ranks& ranks, std::int32_t threads) : team_(team), ranks_(ranks), threads_(threads) {}

  [[nodiscard]] PlaceKind kind() const override { return kSubdomains; }
  [[nodiscard]] std::int32_t ranks() const override { return team_.ranks(); }
  [[nodiscard]] Processes processes() const override { return processes_of(team_); }
  [[nodiscard]] IdVector<Rank, double> speeds(const Request& request) const override;
  [[nodiscard]] bool leads() const override { return team_.leads(); }
  [[nodiscard]] Order share(const std::function<Order()>& make) override;
  [[nodiscard]] std::unique_ptr<Refined> refine(Order&& order, const Limits& limits, const SizeField* size,
                                                Watch& watch) override;

 private:
  Team& team_;
  Ranks& ranks_;
  std::int32_t threads_;
};

}  // namespace driftmesh::job
