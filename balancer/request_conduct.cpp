#include "balancer/request_conduct.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "balancer/admissions.hpp"
#include "balancer/snapshot/deliberation.hpp"

namespace driftmesh::balancer {
namespace {

constexpr Rank kBroker{0};
constexpr std::uint32_t kMostRivals = 15;

double seconds_of(double work, double speed) {
  return work <= 0 ? 0 : speed > 0 ? work / speed : HUGE_VAL;
}

// Triangles for which their destination needs memory.
double memory_needed(std::span<const Move> moves, const std::vector<ReportedLoad>& own) {
  double needed = 0;
  for (const Move& move : moves)
    if (const auto load = std::ranges::find(own, move.subdomain, &ReportedLoad::subdomain); load != own.end())
      needed += room_for(*load);
  return needed;
}

// The amount that makes both finish at the same time.
double even_share(const RankLoad& victim, double victim_speed, const RankLoad& thief, double thief_speed) {
  const double share = (victim.remaining * thief_speed - thief.remaining * victim_speed) / (victim_speed + thief_speed);
  return std::max(0.0, share);
}

}  // namespace

RequestConduct::RequestConduct(Rank self, std::shared_ptr<const Layout> layout, std::shared_ptr<const Policy> policy,
                               const ControllerOptions& options, double now)
    : self_(self),
      layout_(std::move(layout)),
      policy_(std::move(policy)),
      options_(options),
      rule_(options.gap, options.interval, options.change) {
  double predicted = 0;
  for (const Layout::Subdomain& s : layout_->subdomains) predicted += s.predicted;
  constexpr double kOfMean = 0.25;
  crumbs_ = kOfMean * predicted / static_cast<double>(std::max<std::size_t>(1, layout_->subdomains.size()));
  if (self == kBroker) news_.emplace(*layout_, now);
}

void RequestConduct::receive(Rank source, Message advice, double now) {
  if (const auto* const news = std::get_if<LoadNews>(&advice)) {
    if (news_) take_news(source, *news, now);
  } else if (const auto* const request = std::get_if<WorkRequest>(&advice)) {
    requests_.push_back(*request);
  } else if (const auto* const answer = std::get_if<WorkAnswer>(&advice)) {
    take_answer(source, *answer, now);
  }
}

void RequestConduct::take_answer(Rank source, const WorkAnswer& answer, double now) {
  if (asked_ && answer.round == round_) {
    asked_ = false;
    // The broker refuses when nobody has anything to give; then the broker will come back to it.
    remembered_ = answer.moves.empty() && source == kBroker;
    if (!remembered_) ++refusals_;
  } else if (answer.round == 0) {
    remembered_ = false;  // it came back, and this is what came of it
    ++refusals_;
  }
  if (answer.moves.empty()) return;
  refusals_ = 0;
  for (const Move& move : answer.moves)
    if (std::find(arrived_.begin(), arrived_.end(), move.subdomain) == arrived_.end())
      coming_.push_back(move.subdomain);
  promised_ = now;
}

void RequestConduct::take_news(Rank source, const LoadNews& news, double now) {
  if (news_->hear(source, news, now)) surprised_ = true;
  if (news.spare > crumbs_) hungry_.erase(source);
  if (news.remaining <= 0 && hungry_.contains(source)) surprised_ = true;  // now it would gain more
}

void RequestConduct::arrived(SubdomainId id) {
  arrived_.push_back(id);
  std::erase(coming_, id);
}

Decision RequestConduct::think(const Situation& situation) {
  Decision decision;
  board_.reset();
  Loads own(situation.own.begin(), situation.own.end());
  notice_end_of_work(own);
  for (const WorkRequest& request : std::exchange(requests_, {}))
    if (self_ == kBroker)
      place(request, situation, own, decision);
    else
      give(request, situation, own, decision);
  if (self_ == kBroker) feed_hungry(situation, own, decision);
  report(situation, own, decision);
  forget_promises(situation.now);
  ask(situation, own, decision);
  return decision;
}

// Without any work a rank tries once more, even if givers have refused it often: it would gain more now.
void RequestConduct::notice_end_of_work(const Loads& own) {
  if (std::exchange(idle_, own.empty()) || !idle_) return;
  refusals_ = std::min(refusals_, options_.refusals - 1);
  if (hungry_.contains(self_)) surprised_ = true;
}

// Returns how much work is given.
double RequestConduct::give(const WorkRequest& request, const Situation& situation, Loads& own, Decision& decision) {
  WorkAnswer answer{request.round, gifts(request, situation, own)};
  const double before = total_work(own);
  // If a rank has not asked now, the broker knows what it once had: that may be much less by now.
  constexpr double kCautiously = 4;
  const double givers = request.round == 0 ? kCautiously * kUnawareGivers : kUnawareGivers;
  const bool asks = must_ask(request.free_memory, memory_needed(answer.moves, own), 0, givers);
  for (const Move& move : answer.moves) {
    take_out(own, move.subdomain);
    (asks ? decision.asks : decision.moves).push_back(move);
  }
  changed_ = true;
  decision.messages.push_back({request.thief, std::move(answer)});
  return before - total_work(own);
}

// The worthwhile part of what the policy gives, considering only the two ranks, without what the thief would begin
// beyond the horizon. To the policy, the giver appears as fast as all ranks together that will share the rest.
std::vector<Move> RequestConduct::gifts(const WorkRequest& request, const Situation& situation,
                                        const Loads& own) const {
  LoadSnapshot snapshot;
  snapshot.layout = layout_;
  snapshot.ranks.resize(to_index(layout_->ranks));
  const double speed = situation.speed > 0 ? situation.speed : request.speed > 0 ? request.speed : 1;
  const double sharers = 1 + std::min(request.rivals, kMostRivals);
  snapshot.ranks[request.thief] = {request.speed > 0 ? request.speed : speed, request.remaining, request.doubt,
                                   request.free_memory};
  snapshot.ranks[self_] = {sharers * speed, total_work(own), situation.doubt};
  snapshot.subdomains = states_of(self_, own);
  std::vector<Move> moves = policy_->give(snapshot, self_, request.thief);
  double theirs = request.remaining;
  const double most = request.horizon * snapshot.ranks[request.thief].speed;
  std::erase_if(moves, [&](const Move& move) {
    if (theirs > most) return true;
    theirs += find(snapshot, move.subdomain)->remaining;
    return false;
  });
  snapshot.ranks[self_].speed = speed;
  return worth_moving(snapshot, moves, options_.cost, options_.worth);
}

void RequestConduct::report(const Situation& situation, const Loads& own, Decision& decision) {
  const double total = total_work(own);
  if (!rule_.due(situation.now, total, situation.speed, changed_)) return;
  rule_.told(situation.now, total, situation.speed);
  changed_ = false;
  if (self_ != kBroker)
    decision.messages.push_back({kBroker, news_of(++reports_, situation, own)});
  else if (news_->hear(self_, news_of(++reports_, situation, own), situation.now))
    surprised_ = true;
}

// What the giver could not hand over after all is not waited for without end.
void RequestConduct::forget_promises(double now) {
  if (now > promised_ + options_.interval) coming_.clear();
}

void RequestConduct::ask(const Situation& situation, Loads& own, Decision& decision) {
  const double total = total_work(own);
  const double next = own.empty() ? 0 : total - own.front().remaining - crumbs_;
  const bool low = policy_->runs_low(seconds_of(next, situation.speed) - options_.time_to_get_work());
  if (!low) refusals_ = 0, remembered_ = false;
  const bool tries = !remembered_ && refusals_ < options_.refusals;
  if (!low || asked_ || !coming_.empty() || !tries || situation.free_memory <= 0) return;
  const WorkRequest request{self_, ++round_, total, situation.speed, 0, situation.doubt, situation.free_memory};
  arrived_.clear();
  if (self_ != kBroker) {
    asked_ = true;
    decision.messages.push_back({kBroker, request});
  } else if (pass_on(request, situation, own, decision)) {
    asked_ = true;
  } else {
    remembered_ = true;
    hungry_.insert(self_);
  }
}

void RequestConduct::place(const WorkRequest& request, const Situation& situation, Loads& own, Decision& decision) {
  news_->hear_memory(request.thief, request.free_memory);
  if (pass_on(request, situation, own, decision)) return;
  hungry_.insert(request.thief);
  decision.messages.push_back({request.thief, WorkAnswer{request.round, {}}});
}

bool RequestConduct::pass_on(WorkRequest request, const Situation& situation, Loads& own, Decision& decision) {
  const double now = situation.now;
  news_->hear(self_, news_of(++reports_, situation, own), now);
  if (!board_) board_.emplace(*news_, layout_, now);
  const auto put = [&](Rank rank, const RankLoad& state) { board_->put(rank, state, news_->can_give(rank, state)); };
  const RankLoad thief{request.speed, request.remaining, request.doubt, request.free_memory};
  put(self_, news_->state(self_, now));
  put(request.thief, thief);
  request.rivals = board_->rivals();
  request.horizon = horizon();
  const auto [victim, share] = find_giver(request);
  if (is_logged())
    note({.subject = Deliberation::Subject::kRequest,
          .verdict = victim ? Verdict::kDone : Verdict::kNoGiver,
          .thief = request.thief,
          .giver = victim.value_or(request.thief)});
  if (victim) {
    hungry_.erase(request.thief);
    if (*victim == self_) {
      const double given = give(request, situation, own, decision);
      if (given <= 0) hungry_.insert(request.thief);
      news_->expect(self_, request.thief, given, now);
    } else {
      news_->expect(*victim, request.thief, share, now);
      decision.messages.push_back({*victim, request});
    }
    put(*victim, news_->state(*victim, now));
  }
  put(request.thief, news_->state(request.thief, now));
  return victim.has_value();
}

// And about how much it will give. Nobody, if the thief has work up to the horizon, or an even load of the two would
// save less than a move must.
RequestConduct::Giver RequestConduct::find_giver(const WorkRequest& request) const {
  const double thief_speed = news_->known_or_mean(request.speed);
  const RankLoad& thief = board_->snapshot().ranks[request.thief];
  if (thief.remaining > request.horizon * thief_speed) return {};
  const auto victim = policy_->victim(board_->snapshot(), request.thief, board_->able());
  if (!victim) return {};
  const RankLoad& giver = board_->snapshot().ranks[*victim];
  const double speed = news_->known_or_mean(giver.speed);
  const double sharers = 1 + std::min(request.rivals, kMostRivals);
  const double share = even_share(giver, sharers * speed, thief, thief_speed);
  const double required = std::max(options_.worth.seconds, options_.worth.gain * giver.remaining / speed);
  return share / speed < required ? Giver{} : Giver{victim, share};
}

// Not much more than the ideal time: what a slow rank would begin later would have to move again. How long that is can
// be said when all ranks have told their speeds.
double RequestConduct::horizon() const {
  constexpr double kOfIdeal = 1.25;
  return news_->complete() ? kOfIdeal * board_->ideal_time() : kNoHorizon;
}

// The broker repeats its own requests; it passes on all others without waiting for an answer.
void RequestConduct::feed_hungry(const Situation& situation, Loads& own, Decision& decision) {
  if (!std::exchange(surprised_, false)) return;
  const std::set<Rank> hungry = hungry_;
  for (const Rank thief : hungry) {
    const RankLoad state = news_->state(thief, situation.now);
    if (thief == self_)
      refusals_ = 0, remembered_ = false, hungry_.erase(thief);
    else if (!pass_on({thief, 0, state.remaining, state.speed, 0, state.doubt, state.free_memory}, situation, own,
                      decision) &&
             state.remaining <= 0)
      return;  // nobody has anything for the others either
  }
}

}  // namespace driftmesh::balancer
