#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "driftmesh/size_field.hpp"
#include "migration/subdomain.hpp"
#include "migration/subdomains.hpp"
#include "runtime/rank_outcome.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh {

/// Refinement by threads of this process. Each thread is a rank with a loop of its own, and subdomains move between
/// them as the plan's policy says.
///
/// The mesh depends on the subdomains alone, neither on the number of threads nor on who is faster: in a round each
/// subdomain meets its bounds without knowing what its neighbors put on their common borders meanwhile; between rounds
/// all learn it, in the order of roots and paths. After a round in which nobody put a point on a border, the mesh
/// conforms. Presplit interfaces need one round; others need few, since the later ones only follow up on single points.
class RefinementInRounds {
 public:
  /// Each may be empty. An exception thrown by one of them ends the run.
  struct Watch {
    /// Called by the calling thread from time to time with the triangles of all threads so far.
    std::function<void(std::int64_t triangles)> progress{};
    /// Called by each thread after a slice of work, at the same time as others.
    std::function<void(std::int64_t triangles)> check{};
    /// Called by a thread, which has that field of `sizes`, when a subdomain has nothing to do, for now.
    std::function<void(const Subdomain&, const SizeField*)> finished{};
    /// A thread waits for the others for very long.
    std::function<void(const std::string& why)> stalled{};
  };

  /// One thread for each of `sizes`: its own object of the same size field, or null, in place of the plan's. The plan
  /// maps subdomains to as many ranks. `plan` and the fields must outlive the object.
  RefinementInRounds(const RunPlan& plan, std::span<const SizeField* const> sizes, Watch watch);
  ~RefinementInRounds();
  RefinementInRounds(const RefinementInRounds&) = delete;
  RefinementInRounds& operator=(const RefinementInRounds&) = delete;

  /// Refines until all bounds are met. Throws what the first thread to fail throws; then the mesh is incomplete.
  void run();

  // After run():

  /// All subdomains.
  [[nodiscard]] const std::map<SubdomainId, Subdomain>& subdomains() const { return subdomains_; }
  /// The same, to be taken apart.
  [[nodiscard]] std::map<SubdomainId, Subdomain>& subdomains() { return subdomains_; }
  [[nodiscard]] IdSpan<Rank, const RankOutcome> outcomes() const { return outcomes_; }
  [[nodiscard]] int rounds() const { return rounds_; }

 private:
  struct Told;
  class ToldLater;
  class Round;

  [[nodiscard]] LoopPlan present_plan() const;
  [[nodiscard]] bool tell_neighbors(const std::vector<Told>& told);

  const RunPlan& plan_;
  Watch watch_;
  IdVector<Rank, SubdomainContext> contexts_;  // one for each of held_
  IdVector<Rank, Subdomains> held_;            // until all rounds are over
  std::map<SubdomainId, Subdomain> subdomains_;
  IdVector<Rank, RankOutcome> outcomes_;
  int rounds_ = 0;
};

}  // namespace driftmesh
