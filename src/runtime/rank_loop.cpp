#include "runtime/rank_loop.hpp"

#include <utility>

#include "balancer/codec.hpp"
#include "driftmesh/error.hpp"
#include "protocol/codec.hpp"
#include "protocol/protocol_error.hpp"

namespace driftmesh {

RankLoop::RankLoop(protocol::Transport& transport, const RunPlan& plan, IdSpan<SubdomainId, const Rank> owners,
                   Observers observers, const protocol::Rules& rules)
    : transport_(transport),
      plan_(plan),
      own_context_{&plan.decomposition, plan.bounds, plan.presplit},
      observers_(std::move(observers)),
      rules_(rules),
      protocol_(transport.rank(), transport.ranks(), owners, plan.work.aggregation, rules),
      limits_{transport.ranks(), static_cast<std::int32_t>(owners.size()),
              static_cast<std::int32_t>(plan.decomposition.roots.size())},
      agenda_(plan.work.order),
      clock_(transport.now()) {}

RankLoop::RankLoop(protocol::Transport& transport, const RunPlan& plan, const CostModel& costs, Observers observers,
                   balancer::Council* council, const protocol::Rules& rules)
    : RankLoop(transport, plan, plan.owners, std::move(observers), rules) {
  costs_ = costs;
  balance_with(plan.layout, council);
  for (const SubdomainId s : ids_of(plan.owners))
    if (plan.owners[s] == transport.rank()) put(Subdomain(s, *context_));
}

RankLoop::RankLoop(protocol::Transport& transport, Round round, const RunPlan& plan, Observers observers)
    : RankLoop(transport, plan, round.owners, std::move(observers), protocol::sound_rules()) {
  in_rounds_ = true;
  context_ = round.context;
  balance_with(std::move(round.layout), nullptr);
  for (auto& [id, subdomain] : round.subdomains) put(std::move(subdomain));
}

void RankLoop::balance_with(std::shared_ptr<const balancer::Layout> layout, balancer::Council* council) {
  if (plan_.policy)
    controller_.emplace(transport_.rank(), std::move(layout), plan_.policy, plan_.balancing.options, clock_, council);
}

bool RankLoop::hand_over(SubdomainId id, Rank to) {
  const auto place = subdomains_.find(id);
  if (to == transport_.rank() || place == subdomains_.end() || !place->second.active() || abandoned_) return false;
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

void RankLoop::abandon() {
  if (abandoned_) return;
  drop_work();
  protocol_.abandon();
}

void RankLoop::drop_work() {
  abandoned_ = true;
  own_failure_ = false;
  agenda_.clear();
  if (controller_) controller_->give_up();
}

protocol::StepResult RankLoop::step() {
  charge(&RankTimes::idle);
  const bool heard = poll();
  charge(agenda_.empty() && !heard ? &RankTimes::idle : &RankTimes::polling);
  const bool came_first = controller_ && controller_->pressing() && balance(worked_);
  const bool worked = work();
  charge(worked ? &RankTimes::computing : &RankTimes::idle);
  const bool balanced = balance(worked) || came_first;
  if (rules_.rests(worked)) protocol_.rest(!controller_ || !controller_->waiting());
  const bool sent = send();
  charge(sent || worked ? &RankTimes::sending : &RankTimes::idle);
  watch(heard || worked || balanced || sent);
  if (protocol_.finished()) return protocol::StepResult::kFinished;
  return heard || worked ? protocol::StepResult::kBusy : protocol::StepResult::kIdle;
}

RankOutcome RankLoop::outcome() const {
  return {times_,    protocol_.counters(), triangles_, static_cast<std::int32_t>(subdomains_.size()), interface_splits_,
          messages_, message_bytes_};
}

bool RankLoop::at_work() const {
  return !agenda_.empty() || protocol_.aggregated() > 0 || protocol_.held_groups() > 0;
}

void RankLoop::put(Subdomain&& subdomain) {
  const SubdomainId id = subdomain.id();
  triangles_ += subdomain.triangles();
  const auto [place, is_new] = subdomains_.insert_or_assign(id, std::move(subdomain));
  reschedule(place->second);
}

void RankLoop::reschedule(const Subdomain& s) {
  if (s.active() && !abandoned_)
    agenda_.put({s.id(), s.started() && !s.refined(), s.refined(), s.remaining(), s.backlog()});
  else
    agenda_.remove(s.id());
}

bool RankLoop::poll() {
  bool heard = false;
  while (const auto received = transport_.poll()) {
    heard = true;
    auto delivery = protocol_.receive(received->source, protocol::decode(received->source, received->bytes, limits_));
    if (delivery.arrival) settle(*delivery.arrival, received->source);
    if (delivery.abandoned) drop_work();
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

void RankLoop::settle(const protocol::HandOff& arrival, Rank sender) {
  charge(&RankTimes::polling);
  protocol::read_from(sender, [&] { put(Subdomain::unpack(arrival.packed, *context_, Source::kThisRun)); });
  transport_.spend(static_cast<double>(arrival.packed.size()) * costs_.packed_byte);
  charge(&RankTimes::balancing);
  if (controller_) controller_->arrived(arrival.subdomain, arrival.epoch, clock_);
  if (observers_.settled)
    observers_.settled(*this, {arrival.subdomain, arrival.epoch, transport_.rank(), arrival.packed.size()});
}

// One slice of work on the next subdomain. False if none has anything to do.
bool RankLoop::work() {
  const auto id = agenda_.first();
  if (!id) return false;
  Subdomain& subdomain = subdomains_.at(*id);
  said_.clear();
  own_failure_ = true;
  const std::int64_t before = subdomain.triangles();
  const double start = transport_.now();
  const SliceWork done = subdomain.work(plan_.work.slice, said_);
  triangles_ += subdomain.triangles() - before;
  if (triangles_ > plan_.max_triangles)
    throw LimitError("rank " + to_string(transport_.rank()) + " has more than " + std::to_string(plan_.max_triangles) +
                     " triangles");
  transport_.spend(static_cast<double>(done.points) * costs_.point +
                   (done.prepared > 0 ? costs_.start + static_cast<double>(done.prepared) * costs_.prepared : 0));
  reschedule(subdomain);
  if (done.woken > 0) transport_.spend(static_cast<double>(done.woken) * costs_.woken);
  if (observers_.finished && !subdomain.active()) observers_.finished(subdomain);
  if (plan_.work.sleep && !subdomain.active()) {
    subdomain.sleep();
    transport_.spend(static_cast<double>(subdomain.triangles()) * costs_.asleep);
  }
  interface_splits_ += static_cast<std::int64_t>(said_.size());
  for (const SplitPoint<GlobalRootId>& split : said_) tell_across(*id, split);
  if (observers_.after_slice) observers_.after_slice(*this, {*id, transport_.now() - start, said_});
  speed_.add({static_cast<double>(done.triangles), transport_.now() - start, done.prepared > 0, !subdomain.active()});
  own_failure_ = false;
  return true;
}

// Calls the controller when it is due or work has just run out, but not after termination. Returns whether it did
// anything.
bool RankLoop::balance(bool worked) {
  const bool ran_out = std::exchange(worked_, worked) && agenda_.empty();
  if (!controller_ || !(controller_->due(clock_) || ran_out)) return false;
  if (protocol_.phase() != protocol::Termination::Phase::kWorking) return false;
  const double start = transport_.now();
  const std::vector<balancer::ReportedLoad> own = loads();
  transport_.spend(static_cast<double>(own.size()) * costs_.listed);
  own_failure_ = plan_.policy->placement() != balancer::Placement::kCollective;
  balancer::Decision decision = controller_->think(clock_, own, speed_.value());
  own_failure_ = false;
  for (const balancer::Move& move : decision.moves) hand_over(move.subdomain, move.destination);
  for (const balancer::Outgoing& o : decision.messages) protocol_.advise(o.destination, balancer::encode(o.message));
  if (decision.planned) controller_->took(transport_.now() - start);
  charge(&RankTimes::balancing);
  return !decision.moves.empty() || !decision.messages.empty();
}

// The work here, in order.
std::vector<balancer::ReportedLoad> RankLoop::loads() const {
  std::vector<balancer::ReportedLoad> own;
  for (const SubdomainId id : agenda_.in_order()) {
    const Subdomain& s = subdomains_.at(id);
    own.push_back({id, protocol_.where(id).epoch, s.remaining(), s.packed_bytes()});
  }
  return own;
}

void RankLoop::tell_across(SubdomainId from, const SplitPoint<GlobalRootId>& split) {
  if (in_rounds_) return;
  const SubdomainId to = plan_.decomposition.roots[split.root].across_from(from);
  if (!protocol_.holds(to)) return protocol_.send_split(to, split);
  Subdomain& neighbor = subdomains_.at(to);
  neighbor.tell(split);
  reschedule(neighbor);
}

bool RankLoop::send() {
  const auto outgoing = protocol_.take_outgoing();
  for (const protocol::Outgoing& o : outgoing) {
    Bytes bytes = protocol::encode(o.message);
    ++messages_;
    message_bytes_ += bytes.size();
    transport_.send(o.destination, std::move(bytes));
  }
  return !outgoing.empty();
}

// Adds the time since the last call to one category.
void RankLoop::charge(double RankTimes::*kind) {
  const double now = transport_.now();
  times_.*kind += now - std::exchange(clock_, now);
}

void RankLoop::watch(bool moved) {
  if (moved)
    watchdog_.moved(clock_);
  else if (watchdog_.barks(clock_) && observers_.stalled && (waits() || watchdog_.quiet(clock_) >= kLongSeconds))
    observers_.stalled("nothing has moved for " + std::to_string(static_cast<int>(watchdog_.quiet(clock_))) + " s; " +
                       protocol_.describe());
}

// Whether this rank waits for a message. A rank that has finished waits for the others, too, but that may well take
// long.
bool RankLoop::waits() const {
  return at_work() || (controller_ && controller_->waiting()) ||
         protocol_.phase() != protocol::Termination::Phase::kWorking;
}

}  // namespace driftmesh
