#include "runtime/rank_loop.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "balancer/snapshot/codec.hpp"
#include "balancer/snapshot/effort.hpp"
#include "driftmesh/error.hpp"
#include "protocol/codec.hpp"
#include "protocol/packed_size.hpp"
#include "protocol/protocol_error.hpp"

namespace driftmesh {

RankLoop::RankLoop(protocol::Transport& transport, const LoopPlan& plan, Holding& held, Coupling& coupling,
                   const CostModel& costs, Observers observers, const protocol::Rules& rules)
    : transport_(transport),
      plan_(plan),
      held_(held),
      coupling_(coupling),
      costs_(costs),
      observers_(std::move(observers)),
      rules_(rules),
      protocol_(transport.rank(), transport.ranks(), plan.owners, plan.work.aggregation, rules),
      limits_{transport.ranks(), static_cast<std::int32_t>(plan.owners.size()), coupling.roots()},
      agenda_(plan.work.order),
      experience_(plan.balancing.options.work_to_start),
      clock_(transport.now()) {
  if (plan_.policy) controller_.emplace(transport_.rank(), plan_.layout, plan_.policy, plan_.balancing.options, clock_);
  held_.each([this](const Work& work) { count_in(work); });
}

RankLoop::~RankLoop() {
  while (!out_.empty()) {
    crew_->wait();
    while (const Shift* const shift = crew_->finished()) out_.erase(shift->work->id());
  }
}

bool RankLoop::hand_over(SubdomainId id, Rank to) {
  const Work* const work = held_.find(id);
  if (to == transport_.rank() || work == nullptr || out_.contains(id)) return false;
  const WorkState state = work->state();
  if (!state.active || abandoned_) return false;
  if (state.packed_bytes > protocol::kMostPackedBytes) return false;
  triangles_ -= state.triangles;
  Bytes packed = work->pack();
  transport_.spend(static_cast<double>(packed.size()) * costs_.packed_byte);
  agenda_.remove(id);
  experience_.left(id);
  held_.drop(id);
  if (observers_.handed_over) observers_.handed_over(*this, {id, protocol_.where(id).epoch + 1, to, packed.size()});
  protocol_.hand_off(id, to, std::move(packed));
  return true;
}

void RankLoop::abandon() {
  if (abandoned_) return;
  drop_work();
  if (!alone()) protocol_.abandon();
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
  if (came_first && send()) charge(&RankTimes::sending);  // what it calls for goes out at once
  const bool worked = work();
  if (!worked && !heard && !out_.empty()) crew_->wait();
  charge(worked || !out_.empty() ? &RankTimes::computing : &RankTimes::idle);
  const bool balanced = balance(worked) || came_first;
  if (out_.empty() && !alone() && rules_.rests(worked)) protocol_.rest(!controller_ || !controller_->waiting());
  const bool sent = send();
  charge(sent || worked ? &RankTimes::sending : &RankTimes::idle);
  watch(heard || worked || balanced || sent || !out_.empty());
  if (protocol_.finished() || (alone() && !at_work())) return protocol::StepResult::kFinished;
  return heard || worked || !out_.empty() ? protocol::StepResult::kBusy : protocol::StepResult::kIdle;
}

RankOutcome RankLoop::outcome() const {
  std::int32_t subdomains = 0;
  held_.each([&](const Work&) { ++subdomains; });
  return {times_, protocol_.counters(), triangles_, subdomains, interface_splits_, messages_, message_bytes_};
}

bool RankLoop::at_work() const {
  return !agenda_.empty() || !out_.empty() || protocol_.aggregated() > 0 || protocol_.held_groups() > 0;
}

// What the protocol says is here.
Work& RankLoop::at(SubdomainId id) const {
  Work* const work = held_.find(id);
  if (work == nullptr) throw Error("subdomain " + to_string(id) + " is not on rank " + to_string(transport_.rank()));
  return *work;
}

void RankLoop::count_in(const Work& work) {
  const WorkState state = work.state();
  triangles_ += state.triangles;
  reschedule(work.id(), state);
}

void RankLoop::reschedule(SubdomainId id, const WorkState& s) {
  if (s.active && !abandoned_)
    agenda_.put({id, s.started && !s.refined, s.refined, s.remaining, s.backlog});
  else
    agenda_.remove(id);
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
    for (const protocol::SplitGroup& group : delivery.splits) tell(group.to, group.points);
  }
  return heard;
}

void RankLoop::settle(const protocol::HandOff& arrival, Rank sender) {
  charge(&RankTimes::polling);
  protocol::read_from(sender, [&] { count_in(held_.unpack(arrival.packed)); });
  transport_.spend(static_cast<double>(arrival.packed.size()) * costs_.packed_byte);
  charge(&RankTimes::balancing);
  if (controller_) controller_->arrived(arrival.subdomain, arrival.epoch);
  if (observers_.settled)
    observers_.settled(*this, {arrival.subdomain, arrival.epoch, transport_.rank(), arrival.packed.size()});
}

// Ends the shifts that the crew has performed, gives it new ones, and performs one here. False if there was none.
bool RankLoop::work() {
  bool any = false;
  while (Shift* const shift = crew_ != nullptr ? crew_->finished() : nullptr) {
    end(*shift, shift->seconds);
    any = true;
  }
  constexpr std::size_t kAhead = 2;  // each finds another shift when it has performed one while this thread works
  for (; crew_ != nullptr && out_.size() < kAhead * crew_->size() && agenda_.size() > 1; any = true)
    crew_->start(begin(*agenda_.first()));
  const auto id = agenda_.first();
  if (!id) return any;
  const double start = transport_.now();
  Shift& own = begin(*id);
  own.perform();
  transport_.spend(
      static_cast<double>(own.done.points) * costs_.point +
      (own.done.prepared > 0 ? costs_.start + static_cast<double>(own.done.prepared) * costs_.prepared : 0) +
      static_cast<double>(own.done.woken) * costs_.woken + static_cast<double>(own.done.asleep) * costs_.asleep +
      own.done.seconds);
  end(own, transport_.now() - start);
  return true;
}

Shift& RankLoop::begin(SubdomainId id) {
  Work& work = at(id);
  const WorkState state = work.state();
  agenda_.remove(id);
  const Shift shift{.work = &work, .insertions = slice()};
  return out_.emplace(id, Out{shift, state.triangles, load_of(id, state), {}}).first->second.shift;
}

// Insertions. Where nothing is balanced, only points of neighbors wait for its end.
std::int64_t RankLoop::slice() const {
  if (!controller_) return plan_.work.slice;
  const auto most = kTrianglesPerPoint * static_cast<double>(plan_.work.slice);
  const double triangles = plan_.balancing.options.triangles_between_looks(most, speed_.value());
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(triangles / kTrianglesPerPoint));
}

void RankLoop::end(Shift& shift, double seconds) {
  Work& work = *shift.work;
  const SubdomainId id = work.id();
  const Out out = std::move(out_.extract(id).mapped());
  if (abandoned_) return;
  own_failure_ = true;
  if (out.shift.failure) std::rethrow_exception(out.shift.failure);
  if (!out.told.empty()) work.tell(out.told);
  const WorkState state = work.state();
  triangles_ += state.triangles - out.triangles;
  if (triangles_ > plan_.max_triangles)
    throw LimitError("rank " + to_string(transport_.rank()) + " has more than " + std::to_string(plan_.max_triangles) +
                     " triangles");
  reschedule(id, state);
  const auto& said = out.shift.said;
  interface_splits_ += static_cast<std::int64_t>(said.size());
  for (const SplitPoint<GlobalRootId>& split : said) tell_across(id, split);
  const double start = transport_.now();
  if (observers_.after_slice) observers_.after_slice(*this, {id, seconds, said});
  seconds += transport_.now() - start;  // a slow rank may be made by waiting there
  const SliceWork& done = out.shift.done;
  learn(id, state, done, seconds);
  const double started = done.begun ? plan_.balancing.options.work_to_start + static_cast<double>(done.prepared) : 0;
  speed_.add({started + static_cast<double>(done.triangles), seconds, done.begun ? out.load.remaining : 0});
  own_failure_ = false;
}

void RankLoop::learn(SubdomainId id, const WorkState& s, const SliceWork& done, double seconds) {
  if (!controller_) return;
  experience_.worked(id, seconds, done.begun);
  if (s.refined)
    experience_.finished(id, (*plan_.layout)[id].on_segments, s.predicted, static_cast<double>(s.triangles));
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
  own_failure_ = true;
  const balancer::EffortLog planning;
  std::optional<balancer::DeliberationLog> considered;
  if (observers_.deliberated) considered.emplace();
  balancer::Decision decision =
      controller_->think(clock_, own, speed_.value() * static_cast<double>(1 + (crew_ != nullptr ? crew_->size() : 0)),
                         experience_.doubt(own), free_memory(own));
  own_failure_ = false;
  if (considered) observers_.deliberated(considered->take());
  transport_.spend(costs_.planning.seconds(planning.efforts()));
  // Only what planning took: packing what it hands over does not make looking at loads more expensive.
  const double took = transport_.now() - start;
  if (decision.planned) controller_->took(took);
  controller_->looked(transport_.now(), took);
  // Messages first: they are short, and must not wait for subdomains to be packed and sent.
  for (const balancer::Outgoing& o : decision.messages) protocol_.advise(o.destination, balancer::encode(o.message));
  for (const balancer::Move& move : decision.moves)
    if (!hand_over(move.subdomain, move.destination)) controller_->stayed(move.subdomain);
  charge(&RankTimes::balancing);
  return !decision.moves.empty() || !decision.messages.empty();
}

// The work here, in order.
std::vector<balancer::ReportedLoad> RankLoop::loads() const {
  std::vector<balancer::ReportedLoad> own;
  for (const auto& [id, out] : out_) own.push_back(out.load);
  for (const SubdomainId id : agenda_.in_order()) own.push_back(load_of(id, at(id).state()));
  return own;
}

balancer::ReportedLoad RankLoop::load_of(SubdomainId id, const WorkState& s) const {
  double remaining = s.remaining;
  if (controller_ && s.active && !s.refined)
    remaining =
        std::max(1 + static_cast<double>(s.backlog),
                 experience_.rest((*plan_.layout)[id].on_segments, s.forecast, static_cast<double>(s.triangles)));
  return {id, protocol_.where(id).epoch, remaining, s.packed_bytes};
}

// Triangles, besides those here and those that they will become.
double RankLoop::free_memory(std::span<const balancer::ReportedLoad> own) const {
  double room = balancer::kAmpleMemory;
  if (plan_.max_triangles < INT64_MAX) room = static_cast<double>(plan_.max_triangles - triangles_);
  if (room_) room = std::min(room, room_());
  constexpr double kForecast = 1.05;  // they may be off by this
  return room < balancer::kAmpleMemory ? std::max(0.0, room - kForecast * balancer::total_work(own)) : room;
}

void RankLoop::tell(SubdomainId to, std::span<const SplitPoint<GlobalRootId>> splits) {
  if (const auto out = out_.find(to); out != out_.end()) {
    out->second.told.insert(out->second.told.end(), splits.begin(), splits.end());
    return;
  }
  Work& work = at(to);
  work.tell(splits);
  reschedule(to, work.state());
}

void RankLoop::tell_across(SubdomainId from, const SplitPoint<GlobalRootId>& split) {
  const std::optional<SubdomainId> to = coupling_.to_tell(from, split);
  if (!to) return;
  if (protocol_.holds(*to))
    tell(*to, std::span(&split, 1));
  else
    protocol_.send_split(*to, split);
}

bool RankLoop::send() {
  if (alone()) return false;
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
