#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "distributed/ranks.hpp"
#include "driftmesh/size_field.hpp"
#include "migration/subdomain.hpp"
#include "migration/subdomains.hpp"
#include "runtime/rank_outcome.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh {

/// Processes that refine a mesh together, each its subdomains. Both outlive the work.
struct HeldOnRanks {
  Ranks& ranks;
  const IdVector<SubdomainId, Rank>& holders;  ///< the rank of each subdomain
};

/// Gives the subdomains of a process, those that `here` names or else all, to its threads in blocks of about equal
/// work. Which thread has which changes nothing but time.
void deal_to_threads(RunPlan& plan, std::int32_t threads, const std::function<bool(SubdomainId)>& here = {});

/// Refinement by threads of this process, or of several that refine a mesh together. Each thread is a rank with a loop
/// of its own, and subdomains move between the threads of a process as the plan's policy says.
///
/// The mesh depends on the subdomains alone, neither on the number of processes or threads nor on who is faster: in a
/// round each subdomain meets its bounds without knowing what its neighbors put on their common borders meanwhile;
/// between rounds all learn it, in the order of roots and paths. After a round in which nobody put a point on a border,
/// the mesh conforms. Presplit interfaces need one round; others need few, since the later ones only follow up on
/// single points.
class RefinementInRounds {
 public:
  /// Each may be empty. An exception thrown by one of them ends the run.
  struct Watch {
    /// Called by the calling thread from time to time with the triangles of all threads so far.
    std::function<void(std::int64_t triangles)> progress{};
    /// Called by the calling thread between two slices, with the triangles of all threads so far and the subdomain that
    /// this one works on next.
    std::function<void(std::int64_t triangles, std::optional<SubdomainId> next)> stepped{};
    /// Called by each thread after a slice of work, at the same time as others.
    std::function<void(std::int64_t triangles)> check{};
    /// Called by each thread between two slices, at the same time as others: whether this process is to come to a
    /// fence.
    std::function<bool()> halts{};
    /// Called at a fence by the calling thread, while nobody works and nothing is under way, with whether the
    /// subdomains of this process have nothing left to do in this round. Returns whether those of no process have. With
    /// others collective: no process goes on before all have come to the fence. Empty: a round has no fences.
    std::function<bool(bool rests)> fence{};
    /// Called after a round with the triangles of all processes, if there are several.
    std::function<void(std::int64_t triangles)> check_all{};
    /// Called by a thread, which has that field of `sizes`, when a subdomain has nothing to do, for now.
    std::function<void(const Subdomain&, const SizeField*)> finished{};
    /// A thread waits for the others for very long.
    std::function<void(const std::string& why)> stalled{};
  };

  /// One thread for each of `sizes`: its own object of the same size field, or null, in place of the plan's. The plan
  /// maps subdomains to as many ranks. `plan` and the fields must outlive the object. `others`: those who refine the
  /// other subdomains of the plan; with them, run() is collective.
  RefinementInRounds(const RunPlan& plan, std::span<const SizeField* const> sizes, Watch watch,
                     std::optional<HeldOnRanks> others = {});
  ~RefinementInRounds();
  RefinementInRounds(const RefinementInRounds&) = delete;
  RefinementInRounds& operator=(const RefinementInRounds&) = delete;

  /// Before run(), to go on from a fence of another run of the same plan, on any number of processes and threads: what
  /// halted() gave there of a subdomain that is here now. Throws Error for other bytes.
  void take_up(SubdomainId s, std::span<const std::byte> halted);

  /// Refines until all bounds are met. Throws what the first thread to fail throws, on all ranks; then the mesh is
  /// incomplete.
  void run();

  // At a fence:

  /// The subdomains here, ascending.
  [[nodiscard]] std::vector<SubdomainId> here() const;
  /// A subdomain and what it has to tell after this round, as bytes.
  [[nodiscard]] Bytes halted(SubdomainId s) const;
  [[nodiscard]] std::int64_t triangles() const;

  // After run():

  /// All subdomains of this process.
  [[nodiscard]] const std::map<SubdomainId, Subdomain>& subdomains() const { return subdomains_; }
  /// The same, to be taken apart.
  [[nodiscard]] std::map<SubdomainId, Subdomain>& subdomains() { return subdomains_; }
  [[nodiscard]] IdSpan<Rank, const RankOutcome> outcomes() const { return outcomes_; }
  /// The number of rounds, and of the present one meanwhile.
  [[nodiscard]] int rounds() const { return rounds_; }

 private:
  struct Told;
  class ToldLater;
  class Round;

  [[nodiscard]] LoopPlan present_plan() const;
  void refine_for_a_round();
  void refine_until_fence();
  [[nodiscard]] bool rests() const;
  [[nodiscard]] const Subdomain& at(SubdomainId s) const;
  [[nodiscard]] std::vector<Told> take_told();
  [[nodiscard]] bool tell_neighbors(std::vector<Told> told);
  [[nodiscard]] std::vector<Told> swap_with_ranks(const std::vector<Told>& told);
  [[nodiscard]] bool is_here(SubdomainId s) const { return !others_ || others_->holders[s] == others_->ranks.rank(); }

  const RunPlan& plan_;
  Watch watch_;
  std::optional<HeldOnRanks> others_;
  IdVector<Rank, SubdomainContext> contexts_;  // one for each of held_
  IdVector<Rank, Subdomains> held_;            // until all rounds are over
  std::map<SubdomainId, Subdomain> subdomains_;
  IdVector<Rank, RankOutcome> outcomes_;
  std::map<SubdomainId, std::vector<Told>> told_;  // what each has to tell after the present round
  int rounds_ = 0;
  bool begun_ = false;
};

}  // namespace driftmesh
