#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "balancer/codec.hpp"
#include "balancer/controller.hpp"
#include "balancer/speed_estimate.hpp"
#include "driftmesh/error.hpp"
#include "migration/subdomain.hpp"
#include "protocol/codec.hpp"
#include "protocol/protocol_error.hpp"
#include "protocol/rank_protocol.hpp"
#include "protocol/rank_step.hpp"
#include "protocol/transport.hpp"
#include "runtime/agenda.hpp"
#include "runtime/rank_outcome.hpp"
#include "runtime/rank_times.hpp"
#include "runtime/run_plan.hpp"
#include "runtime/watchdog.hpp"

namespace driftmesh {

/// The loop of one rank: poll the transport, dispatch what arrived, refine one subdomain for a slice, send. It runs on
/// one thread, on real ranks and on simulated ones alike; it waits for nobody, but in a council, and prints nothing.
///
/// `Rules` are the protocol's; tests put broken ones in.
template <class Rules>
class BasicRankLoop {
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
    std::function<void(const BasicRankLoop&, const Slice&)> after_slice;
    /// Nothing has moved for a minute: what this rank waits for, and what waits here.
    std::function<void(const std::string&)> stalled;
    std::function<void(const BasicRankLoop&, const Passage&)> handed_over;
    std::function<void(const BasicRankLoop&, const Passage&)> settled;
  };

  /// `transport`, `plan` and `council` must outlive the loop. Policies by which all ranks plan together need a council.
  BasicRankLoop(protocol::Transport& transport, const RunPlan& plan, const CostModel& costs = {},
                Observers observers = {}, balancer::Council* council = nullptr)
      : transport_(transport),
        plan_(plan),
        context_{&plan.decomposition, plan.bounds, plan.presplit},
        costs_(costs),
        observers_(std::move(observers)),
        protocol_(transport.rank(), transport.ranks(), plan.owners, plan.aggregation),
        limits_{transport.ranks(), static_cast<std::int32_t>(plan.owners.size()),
                static_cast<std::int32_t>(plan.decomposition.roots.size())},
        agenda_(plan.order),
        clock_(transport.now()) {
    if (plan.policy)
      controller_.emplace(transport.rank(), plan.layout, plan.policy, plan.balancing.options, clock_, council);
    for (const SubdomainId s : ids_of(plan.owners))
      if (plan.owners[s] == transport.rank()) put(Subdomain(s, context_));
  }
  BasicRankLoop(const BasicRankLoop&) = delete;
  BasicRankLoop& operator=(const BasicRankLoop&) = delete;

  /// Subdomain `id` goes to rank `to`, packed, with everything it was told. Between steps only, and not once this rank
  /// has nothing to do: then it may make no work for others (docs/protocol.md, rule 6). False, and nothing happens, if
  /// the subdomain is not here, is finished, would stay, or is too large for one message.
  bool hand_over(SubdomainId id, Rank to) {
    const auto place = subdomains_.find(id);
    if (to == transport_.rank() || place == subdomains_.end() || !place->second.active()) return false;
    if (place->second.packed_bytes() > protocol::kMostPackedBytes) return false;
    triangles_ -= place->second.triangles();
    Bytes packed = place->second.pack();
    transport_.spend(static_cast<double>(packed.size()) * costs_.packed_byte);
    agenda_.remove(id);
    subdomains_.erase(place);
    if (observers_.handed_over) observers_.handed_over(*this, {id, protocol_.where(id).epoch + 1, to, packed.size()});
    protocol_.hand_off(id, to, std::move(packed));
    return true;
  }

  /// One round. What it throws ends the run on all ranks.
  protocol::StepResult step() {
    charge(&RankTimes::idle);
    const bool heard = poll();
    charge(agenda_.empty() && !heard ? &RankTimes::idle : &RankTimes::polling);
    const bool came_first = controller_ && controller_->pressing() && balance(worked_);
    const bool worked = work();
    charge(worked ? &RankTimes::computing : &RankTimes::idle);
    const bool balanced = balance(worked) || came_first;
    if (Rules::rests(worked)) protocol_.rest(!controller_ || !controller_->waiting());
    const bool sent = send();
    charge(sent || worked ? &RankTimes::sending : &RankTimes::idle);
    watch(heard || worked || balanced || sent);
    if (protocol_.finished()) return protocol::StepResult::kFinished;
    return heard || worked ? protocol::StepResult::kBusy : protocol::StepResult::kIdle;
  }

  [[nodiscard]] const protocol::BasicRankProtocol<Rules>& protocol() const { return protocol_; }
  [[nodiscard]] const std::map<SubdomainId, Subdomain>& subdomains() const { return subdomains_; }
  [[nodiscard]] const RankTimes& times() const { return times_; }
  [[nodiscard]] std::int64_t triangles() const { return triangles_; }  ///< of all subdomains here
  /// Points that refinement put on interfaces here, whoever holds the other side.
  [[nodiscard]] std::int64_t interface_splits() const { return interface_splits_; }
  /// What this rank came to so far.
  [[nodiscard]] RankOutcome outcome() const {
    return {
        times_,    protocol_.counters(), triangles_, static_cast<std::int32_t>(subdomains_.size()), interface_splits_,
        messages_, message_bytes_};
  }
  /// Whether something here is work, or will become some.
  [[nodiscard]] bool at_work() const {
    return !agenda_.empty() || protocol_.aggregated() > 0 || protocol_.held_groups() > 0;
  }

 private:
  void put(Subdomain&& subdomain) {
    const SubdomainId id = subdomain.id();
    triangles_ += subdomain.triangles();
    const auto [place, is_new] = subdomains_.insert_or_assign(id, std::move(subdomain));
    reschedule(place->second);
  }

  void reschedule(const Subdomain& s) {
    if (s.active())
      agenda_.put({s.id(), s.started() && !s.refined(), s.refined(), s.remaining(), s.backlog()});
    else
      agenda_.remove(s.id());
  }

  bool poll() {
    bool heard = false;
    while (const auto received = transport_.poll()) {
      heard = true;
      auto delivery = protocol_.receive(received->source, protocol::decode(received->source, received->bytes, limits_));
      if (delivery.arrival) settle(*delivery.arrival, received->source);
      if (delivery.advice && controller_)
        controller_->receive(received->source, balancer::decode(received->source, *delivery.advice, limits_), clock_);
      for (const protocol::SplitGroup& group : delivery.splits) {
        Subdomain& subdomain = subdomains_.at(group.to);
        for (const SplitPoint<GlobalRootId>& split : group.points) subdomain.tell(split);
        reschedule(subdomain);
      }
    }
    return heard;
  }

  void settle(const protocol::HandOff& arrival, Rank sender) {
    charge(&RankTimes::polling);
    try {
      put(Subdomain::unpack(arrival.packed, context_, Source::kThisRun));
    } catch (const Error& error) {
      throw protocol::ProtocolError(sender, error.what());
    }
    transport_.spend(static_cast<double>(arrival.packed.size()) * costs_.packed_byte);
    charge(&RankTimes::balancing);
    if (controller_) controller_->arrived(arrival.subdomain, arrival.epoch, clock_);
    if (observers_.settled)
      observers_.settled(*this, {arrival.subdomain, arrival.epoch, transport_.rank(), arrival.packed.size()});
  }

  /// A slice of the subdomain whose turn it is. False if none has anything to do.
  bool work() {
    const auto id = agenda_.first();
    if (!id) return false;
    Subdomain& subdomain = subdomains_.at(*id);
    said_.clear();
    const std::int64_t before = subdomain.triangles();
    const double start = transport_.now();
    const SliceWork done = subdomain.work(plan_.slice, said_);
    triangles_ += subdomain.triangles() - before;
    if (triangles_ > plan_.max_triangles)
      throw LimitError("rank " + to_string(transport_.rank()) + " has more than " +
                       std::to_string(plan_.max_triangles) + " triangles");
    transport_.spend(static_cast<double>(done.points) * costs_.point +
                     (done.prepared > 0 ? costs_.start + static_cast<double>(done.prepared) * costs_.prepared : 0));
    reschedule(subdomain);
    if (done.woken > 0) transport_.spend(static_cast<double>(done.woken) * costs_.woken);
    if (plan_.sleep && !subdomain.active()) {
      subdomain.sleep();
      transport_.spend(static_cast<double>(subdomain.triangles()) * costs_.asleep);
    }
    interface_splits_ += static_cast<std::int64_t>(said_.size());
    for (const SplitPoint<GlobalRootId>& split : said_) tell_across(*id, split);
    if (observers_.after_slice) observers_.after_slice(*this, {*id, transport_.now() - start, said_});
    speed_.add({static_cast<double>(done.triangles), transport_.now() - start, done.prepared > 0, !subdomain.active()});
    return true;
  }

  /// Lets the controller look, when it is time or when work has just run out, and not once all work is over. Whether
  /// anything came of it.
  bool balance(bool worked) {
    const bool ran_out = std::exchange(worked_, worked) && agenda_.empty();
    if (!controller_ || !(controller_->due(clock_) || ran_out)) return false;
    if (protocol_.phase() != protocol::Termination::Phase::kWorking) return false;
    const double start = transport_.now();
    const std::vector<balancer::ReportedLoad> own = loads();
    transport_.spend(static_cast<double>(own.size()) * costs_.listed);
    balancer::Decision decision = controller_->think(clock_, own, speed_.value());
    for (const balancer::Move& move : decision.moves) hand_over(move.subdomain, move.destination);
    for (const balancer::Outgoing& o : decision.messages) protocol_.advise(o.destination, balancer::encode(o.message));
    if (decision.planned) controller_->took(transport_.now() - start);
    charge(&RankTimes::balancing);
    return !decision.moves.empty() || !decision.messages.empty();
  }

  /// What is to be done here, in the order in which it will be.
  [[nodiscard]] std::vector<balancer::ReportedLoad> loads() const {
    std::vector<balancer::ReportedLoad> own;
    for (const SubdomainId id : agenda_.in_order()) {
      const Subdomain& s = subdomains_.at(id);
      own.push_back({id, protocol_.where(id).epoch, s.remaining(), s.packed_bytes()});
    }
    return own;
  }

  void tell_across(SubdomainId from, const SplitPoint<GlobalRootId>& split) {
    const SubdomainId to = plan_.decomposition.roots[split.root].across_from(from);
    if (!protocol_.holds(to)) return protocol_.send_split(to, split);
    Subdomain& neighbor = subdomains_.at(to);
    neighbor.tell(split);
    reschedule(neighbor);
  }

  bool send() {
    const auto outgoing = protocol_.take_outgoing();
    for (const protocol::Outgoing& o : outgoing) {
      Bytes bytes = protocol::encode(o.message);
      ++messages_;
      message_bytes_ += bytes.size();
      transport_.send(o.destination, std::move(bytes));
    }
    return !outgoing.empty();
  }

  /// Adds the time since the last call to one kind.
  void charge(double RankTimes::*kind) {
    const double now = transport_.now();
    times_.*kind += now - std::exchange(clock_, now);
  }

  void watch(bool moved) {
    if (moved)
      watchdog_.moved(clock_);
    else if (watchdog_.barks(clock_) && observers_.stalled && (waits() || watchdog_.quiet(clock_) >= kLongSeconds))
      observers_.stalled("nothing has moved for " + std::to_string(static_cast<int>(watchdog_.quiet(clock_))) + " s; " +
                         protocol_.describe());
  }

  /// Whether something must come before this rank can go on. One that is through with its work waits for others to be,
  /// too, but that may well take long.
  [[nodiscard]] bool waits() const {
    return at_work() || (controller_ && controller_->waiting()) ||
           protocol_.phase() != protocol::Termination::Phase::kWorking;
  }

  static constexpr double kWatchdogSeconds = 60, kLongSeconds = 600;

  protocol::Transport& transport_;
  const RunPlan& plan_;
  SubdomainContext context_;
  CostModel costs_;
  Observers observers_;
  protocol::BasicRankProtocol<Rules> protocol_;
  protocol::WireLimits limits_;
  std::map<SubdomainId, Subdomain> subdomains_;
  Agenda agenda_;
  std::optional<balancer::Controller> controller_;
  balancer::SpeedEstimate speed_;
  bool worked_ = false;  // in the last step
  std::vector<SplitPoint<GlobalRootId>> said_;
  std::int64_t triangles_ = 0;
  std::int64_t interface_splits_ = 0;
  std::uint64_t messages_ = 0, message_bytes_ = 0;
  RankTimes times_;
  double clock_;  // when time was charged last
  Watchdog watchdog_{kWatchdogSeconds};
};

using RankLoop = BasicRankLoop<protocol::SoundRules>;

}  // namespace driftmesh
