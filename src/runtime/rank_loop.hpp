#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "balancer/controller.hpp"
#include "balancer/snapshot/deliberation.hpp"
#include "balancer/snapshot/experience.hpp"
#include "balancer/snapshot/speed_estimate.hpp"
#include "migration/work.hpp"
#include "protocol/rank_protocol.hpp"
#include "protocol/rank_step.hpp"
#include "protocol/rules.hpp"
#include "protocol/transport.hpp"
#include "protocol/wire.hpp"
#include "runtime/agenda.hpp"
#include "runtime/coupling.hpp"
#include "runtime/crew.hpp"
#include "runtime/rank_outcome.hpp"
#include "runtime/rank_times.hpp"
#include "runtime/run_plan.hpp"
#include "runtime/watchdog.hpp"

namespace driftmesh {

/// The loop of one rank: poll the transport, dispatch what arrived, work on one subdomain for a slice, send. It runs on
/// one thread, on real ranks and on simulated ones alike; it never waits and prints nothing. A crew may work on other
/// subdomains meanwhile: it does nothing but slices of work, and everything else stays on this thread. What work is
/// (Holding) and how it learns of its neighbors' points (Coupling) is up to whoever makes the loop.
class RankLoop {
 public:
  /// A slice of work that was done.
  struct Slice {
    SubdomainId subdomain{};
    double seconds = 0;
    std::span<const SplitPoint<GlobalRootId>> said;  ///< points that it put on interfaces
  };
  /// A subdomain that leaves this rank or has arrived; `epoch` is the one that starts with this move.
  struct Passage {
    SubdomainId subdomain{};
    protocol::Epoch epoch = 0;
    Rank to{};
    std::size_t bytes = 0;  ///< its packed size
  };
  /// Observers of the loop; each may be empty.
  struct Observers {
    std::function<void(const RankLoop&, const Slice&)> after_slice;
    /// Nothing has moved for a minute: what this rank waits for, and what waits here.
    std::function<void(const std::string&)> stalled;
    std::function<void(const RankLoop&, const Passage&)> handed_over;
    std::function<void(const RankLoop&, const Passage&)> settled;
    /// What the balancer considered, and why it did what it did; without time and rank.
    std::function<void(std::vector<balancer::Deliberation>)> deliberated;
  };

  /// `held` is the work that the plan gives this rank, new or already begun. All parameters but costs and observers
  /// must outlive the loop. `rules` are those of the protocol; tests pass broken ones.
  RankLoop(protocol::Transport& transport, const LoopPlan& plan, Holding& held, Coupling& coupling,
           const CostModel& costs = {}, Observers observers = {},
           const protocol::Rules& rules = protocol::sound_rules());
  /// Waits for the shifts of the crew.
  ~RankLoop();
  RankLoop(const RankLoop&) = delete;
  RankLoop& operator=(const RankLoop&) = delete;

  /// Lets a crew take part in the work from now on. It must outlive the loop, and all work must be
  /// fit for several threads.
  void hire(Crew& crew) { crew_ = &crew; }

  /// Lets the balancer know for how many more triangles this rank has memory, whenever it balances. By default only
  /// those of the plan's limit count.
  void limit_memory(std::function<double()> room) { room_ = std::move(room); }

  /// Moves subdomain `id` to rank `to`, with all points it has received. Only between steps, and not once this rank has
  /// nothing to do: then it must not make work for others (docs/protocol.md, rule 6). Returns false, and does nothing,
  /// if the subdomain is not here, is finished, would stay, is worked on by the crew, or is too large for one message.
  bool hand_over(SubdomainId id, Rank to);

  /// Gives up the run: refinement stops here, and on other ranks once they learn of it. The loop must be stepped until
  /// it is finished; its subdomains are then incomplete. May be called after step() has thrown, if can_abandon().
  void abandon();
  /// Whether this rank or another one has given up the run.
  [[nodiscard]] bool abandoned() const { return abandoned_; }
  /// Whether step() has thrown what a slice of work or the policy threw, so that abandon() can end the run cleanly.
  [[nodiscard]] bool can_abandon() const { return own_failure_; }

  /// One round. An exception ends the run on all ranks, unless can_abandon().
  protocol::StepResult step();

  [[nodiscard]] const protocol::RankProtocol& protocol() const { return protocol_; }
  [[nodiscard]] const Holding& held() const { return held_; }
  [[nodiscard]] const RankTimes& times() const { return times_; }
  [[nodiscard]] std::int64_t triangles() const { return triangles_; }  ///< sum over all subdomains here
  /// Points that refinement inserted on interfaces here, whichever rank holds the other side.
  [[nodiscard]] std::int64_t interface_splits() const { return interface_splits_; }
  /// Results of this rank so far.
  [[nodiscard]] RankOutcome outcome() const;
  /// The subdomain that step() works on next, if any.
  [[nodiscard]] std::optional<SubdomainId> next() const { return agenda_.first(); }
  /// Whether there is work here, or something that will become work.
  [[nodiscard]] bool at_work() const;

 private:
  [[nodiscard]] Work& at(SubdomainId id) const;
  void count_in(const Work& work);
  void reschedule(SubdomainId id, const WorkState& s);
  bool poll();
  void settle(const protocol::HandOff& arrival, Rank sender);
  bool work();
  [[nodiscard]] Shift& begin(SubdomainId id);
  [[nodiscard]] std::int64_t slice() const;
  void end(Shift& shift, double seconds);
  void learn(SubdomainId id, const WorkState& s, const SliceWork& done, double seconds);
  bool balance(bool worked);
  void drop_work();
  [[nodiscard]] std::vector<balancer::ReportedLoad> loads() const;
  [[nodiscard]] balancer::ReportedLoad load_of(SubdomainId id, const WorkState& s) const;
  [[nodiscard]] double free_memory(std::span<const balancer::ReportedLoad> own) const;
  void tell(SubdomainId to, std::span<const SplitPoint<GlobalRootId>> splits);
  void tell_across(SubdomainId from, const SplitPoint<GlobalRootId>& split);
  bool send();
  void charge(double RankTimes::*kind);
  void watch(bool moved);
  [[nodiscard]] bool waits() const;
  /// Whether this rank has nothing to do with the others: it ends with its own work.
  [[nodiscard]] bool alone() const { return plan_.work.decoupled && !controller_; }

  /// A subdomain that is worked on: what it is told must wait, and its load is that at the beginning.
  struct Out {
    Shift shift;
    std::int64_t triangles;
    balancer::ReportedLoad load;
    std::vector<SplitPoint<GlobalRootId>> told;
  };

  static constexpr double kWatchdogSeconds = 60, kLongSeconds = 600;

  protocol::Transport& transport_;
  const LoopPlan& plan_;
  Holding& held_;
  Coupling& coupling_;
  CostModel costs_;
  Observers observers_;
  const protocol::Rules& rules_;
  protocol::RankProtocol protocol_;
  protocol::WireLimits limits_;
  Agenda agenda_;
  Crew* crew_ = nullptr;
  std::map<SubdomainId, Out> out_;
  std::function<double()> room_;
  std::optional<balancer::Controller> controller_;
  balancer::Experience experience_;
  balancer::SpeedEstimate speed_;
  std::optional<double> assembled_since_;  // this rank waits for all others since then
  bool worked_ = false;                    // in the last step
  bool own_failure_ = false;               // what is thrown now concerns this rank alone, or has been thrown
  bool abandoned_ = false;
  std::int64_t triangles_ = 0;
  std::int64_t interface_splits_ = 0;
  std::uint64_t messages_ = 0, message_bytes_ = 0;
  RankTimes times_;
  double clock_;  // time of the last charge
  Watchdog watchdog_{kWatchdogSeconds};
};

}  // namespace driftmesh
