#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "distributed/ranks.hpp"
#include "job/on_ranks.hpp"
#include "job/team.hpp"

namespace driftmesh::job {

class ThreadRun;

/// The ranks of a team that refine in rounds: the mesh is the one that a process makes in subdomains by itself,
/// whatever the number of ranks.
class RoundsOnRanks final : public OnRanks {
 public:
  /// `ranks`: those of the team. Each works with this many threads.
  RoundsOnRanks(Team& team, Ranks& ranks, std::int32_t threads)
      : OnRanks(team, nullptr), ranks_(ranks), threads_(threads) {}

  [[nodiscard]] PlaceKind kind() const override { return kSubdomains; }
  [[nodiscard]] IdVector<Rank, double> speeds(const Request& request) const override;
  [[nodiscard]] Order share(const std::function<Order()>& make) override;
  [[nodiscard]] std::unique_ptr<Refined> refine(Order&& order, const Limits& limits, const SizeField* size,
                                                Watch& watch) override;

 private:
  void refine_together(ThreadRun& run, const Request::Patience& patience, Watch& watch);

  Ranks& ranks_;
  std::int32_t threads_;
};

}  // namespace driftmesh::job
