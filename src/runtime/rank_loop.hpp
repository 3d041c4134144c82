#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "balancer/controller.hpp"
#include "balancer/speed_estimate.hpp"
#include "migration/subdomain.hpp"
#include "protocol/rank_protocol.hpp"
#include "protocol/rank_step.hpp"
#include "protocol/rules.hpp"
#include "protocol/transport.hpp"
#include "protocol/wire.hpp"
#include "runtime/agenda.hpp"
#include "runtime/rank_outcome.hpp"
#include "runtime/rank_times.hpp"
#include "runtime/run_plan.hpp"
#include "runtime/watchdog.hpp"

namespace driftmesh {

/// The loop of one rank: poll the transport, dispatch what arrived, refine one subdomain for a slice, send. It runs on
/// one thread, on real ranks and on simulated ones alike; it waits for nobody, but in a council, and prints nothing.
class RankLoop {
 public:
  /// A slice of work that was done.
  struct Slice {
    SubdomainId subdomain{};
    double seconds = 0;
    std::span<const SplitPoint<GlobalRootId>> said;  ///< points that it put on interfaces
  };
  /// A subdomain that leaves this rank or has come to it; `epoch` is the one that begins with this move.
  struct Passage {
    SubdomainId subdomain{};
    protocol::Epoch epoch = 0;
    Rank to{};
    std::size_t bytes = 0;  ///< its packed size
  };
  /// What the loop tells its surroundings; each may be empty.
  struct Observers {
    std::function<void(const RankLoop&, const Slice&)> after_slice;
    /// Nothing has moved for a minute: what this rank waits for, and what waits here.
    std::function<void(const std::string&)> stalled;
    std::function<void(const RankLoop&, const Passage&)> handed_over;
    std::function<void(const RankLoop&, const Passage&)> settled;
  };

  /// `transport`, `plan`, `council` and `rules` must outlive the loop. Policies by which all ranks plan together need a
  /// council. Rules are the protocol's; tests put broken ones in.
  RankLoop(protocol::Transport& transport, const RunPlan& plan, const CostModel& costs = {}, Observers observers = {},
           balancer::Council* council = nullptr, const protocol::Rules& rules = protocol::sound_rules());
  RankLoop(const RankLoop&) = delete;
  RankLoop& operator=(const RankLoop&) = delete;

  /// Subdomain `id` goes to rank `to`, packed, with everything it was told. Between steps only, and not once this rank
  /// has nothing to do: then it may make no work for others (docs/protocol.md, rule 6). False, and nothing happens, if
  /// the subdomain is not here, is finished, would stay, or is too large for one message.
  bool hand_over(SubdomainId id, Rank to);

  /// Gives the run up: nothing more is refined here, nor on other ranks once they hear of it. The loop is stepped on
  /// until it is finished; what it holds then is no mesh. May be called when step() has thrown what a slice of work
  /// threw.
  void abandon();
  /// Whether this rank or another one has given the run up.
  [[nodiscard]] bool abandoned() const { return abandoned_; }
  /// Whether step() has thrown what a slice of work threw, so that abandon() can end the run in good order.
  [[nodiscard]] bool failed_at_work() const { return at_slice_; }

  /// One round. What it throws ends the run on all ranks, unless it failed_at_work.
  protocol::StepResult step();

  [[nodiscard]] const protocol::RankProtocol& protocol() const { return protocol_; }
  [[nodiscard]] const std::map<SubdomainId, Subdomain>& subdomains() const { return subdomains_; }
  [[nodiscard]] const RankTimes& times() const { return times_; }
  [[nodiscard]] std::int64_t triangles() const { return triangles_; }  ///< of all subdomains here
  /// Points that refinement put on interfaces here, whoever holds the other side.
  [[nodiscard]] std::int64_t interface_splits() const { return interface_splits_; }
  /// What this rank came to so far.
  [[nodiscard]] RankOutcome outcome() const;
  /// Whether something here is work, or will become some.
  [[nodiscard]] bool at_work() const;

 private:
  void put(Subdomain&& subdomain);
  void reschedule(const Subdomain& s);
  bool poll();
  void settle(const protocol::HandOff& arrival, Rank sender);
  bool work();
  bool balance(bool worked);
  void drop_work();
  [[nodiscard]] std::vector<balancer::ReportedLoad> loads() const;
  void tell_across(SubdomainId from, const SplitPoint<GlobalRootId>& split);
  bool send();
  void charge(double RankTimes::*kind);
  void watch(bool moved);
  [[nodiscard]] bool waits() const;

  static constexpr double kWatchdogSeconds = 60, kLongSeconds = 600;

  protocol::Transport& transport_;
  const RunPlan& plan_;
  SubdomainContext context_;
  CostModel costs_;
  Observers observers_;
  const protocol::Rules& rules_;
  protocol::RankProtocol protocol_;
  protocol::WireLimits limits_;
  std::map<SubdomainId, Subdomain> subdomains_;
  Agenda agenda_;
  std::optional<balancer::Controller> controller_;
  balancer::SpeedEstimate speed_;
  bool worked_ = false;    // in the last step
  bool at_slice_ = false;  // of work, or thrown out of it
  bool abandoned_ = false;
  std::vector<SplitPoint<GlobalRootId>> said_;
  std::int64_t triangles_ = 0;
  std::int64_t interface_splits_ = 0;
  std::uint64_t messages_ = 0, message_bytes_ = 0;
  RankTimes times_;
  double clock_;  // when time was charged last
  Watchdog watchdog_{kWatchdogSeconds};
};

}  // namespace driftmesh
