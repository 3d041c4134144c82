#include "balancer/collective_conduct.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "balancer/deliberation.hpp"

namespace driftmesh::balancer {

CollectiveConduct::CollectiveConduct(Rank self, std::shared_ptr<const Layout> layout, const ControllerOptions& options,
                                     Council& council, double now)
    : self_(self),
      layout_(std::move(layout)),
      options_(options),
      council_(council),
      rule_(options.gap, options.interval, options.change),
      start_(now),
      pace_(options, now) {
  if (self == kLeadingRank) news_.emplace(*layout_, now);
}

void CollectiveConduct::receive(Rank source, const Message& advice, double now) {
  if (const auto* const news = std::get_if<LoadNews>(&advice)) {
    if (!leads()) return;
    static_cast<void>(news_->hear(source, *news, now));
    fresh_ = true;
  } else if (const auto* const step = std::get_if<JointRound>(&advice)) {
    take_step(*step);
  }
}

// A start comes after all have answered the call, so it cannot overtake it.
void CollectiveConduct::take_step(const JointRound& step) {
  switch (step.stage) {
    case Step::kCall:
      if (step.round <= round_) return;
      round_ = step.round;
      stage_ = Stage::kCalled;
      return;
    case Step::kReady:
      if (leads() && step.round == round_ && stage_ == Stage::kReady) ++ready_;
      return;
    case Step::kStart:
      if (step.round == round_ && stage_ == Stage::kReady) stage_ = Stage::kStarted;
      return;
  }
}

void CollectiveConduct::arrived(SubdomainId id, double now) {
  came_[id] = now;
  if (!promises_.empty())
    keep_promise();
  else if (waiting())
    ++early_;
}

void CollectiveConduct::keep_promise() {
  JointPlan::Coming& coming = promises_.front().coming;
  coming.work -= coming.work / coming.count;
  if (--coming.count == 0) promises_.pop_front();
}

Decision CollectiveConduct::think(const Situation& situation) {
  Decision decision;
  forget_old(situation);
  // The decision changes what is here; it is reported at the next look.
  if (stage_ == Stage::kStarted) {
    decide(situation, decision);
    return decision;
  }
  if (leads() && stage_ == Stage::kApart) call(situation, decision);
  if (stage_ == Stage::kCalled) answer(decision);
  if (leads() && stage_ == Stage::kReady && ready_ == layout_->ranks) start(decision);
  report(situation, decision);
  return decision;
}

void CollectiveConduct::say_to_all(Step step, Decision& decision) const {
  for (const Rank r : first_ids<Rank>(layout_->ranks))
    if (r != self_) decision.messages.push_back({r, JointRound{round_, step}});
}

void CollectiveConduct::call(const Situation& situation, Decision& decision) {
  const double now = situation.now;
  if (!fresh_ || !pace_.due(now) || expects_work()) return;
  // The first round waits a little for the speeds of all ranks.
  if (!news_->complete() && now < start_ + options_.interval) return;
  fresh_ = false;
  pace_.looked(now);
  LoadSnapshot sums;
  sums.ranks = news_->states(now);
  be_sure_of_idle_ranks(sums);
  const double cost = cost_of_round();
  const Verdict verdict = outlook(sums, options_.worth, cost, options_.time_ahead(ideal_time(sums), cost));
  fresh_ = verdict == Verdict::kTooEarly;  // it will be time without news
  if (verdict != Verdict::kDone || !last_can_give(sums)) return;
  ++round_;
  ready_ = 0;
  stage_ = Stage::kCalled;
  say_to_all(Step::kCall, decision);
}

/// Of the last one, or at first what the collective operations on the way to a decision take at least: each goes up a
/// tree of all ranks and down again.
double CollectiveConduct::cost_of_round() const {
  constexpr double kOperations = 4;
  const double levels = std::ceil(std::log2(std::max(2, layout_->ranks)));
  return std::max(pace_.cost_of_planning(), kOperations * 2 * levels * options_.cost.latency);
}

/// Whether the rank that finishes last has more than it is working on now.
bool CollectiveConduct::last_can_give(const LoadSnapshot& sums) const {
  const IdVector<Rank, double> speeds = assumed_speeds(sums.ranks);
  const Rank last = std::ranges::max(ids_of(speeds), {}, [&](Rank r) { return sums.ranks[r].remaining / speeds[r]; });
  return news_->can_give(last, sums.ranks[last]);
}

void CollectiveConduct::answer(Decision& decision) {
  stage_ = Stage::kReady;
  if (leads())
    ++ready_;
  else
    decision.messages.push_back({kLeadingRank, JointRound{round_, Step::kReady}});
}

// Rank 0 itself decides at its next think(): its messages must be sent before it waits for their receivers.
void CollectiveConduct::start(Decision& decision) {
  say_to_all(Step::kStart, decision);
  stage_ = Stage::kStarted;
}

void CollectiveConduct::decide(const Situation& situation, Decision& decision) {
  const Contribution own = contribution(situation);
  const std::optional<Council::Decision> all = council_.decide(round_, own);
  decision.assembles = !all;
  if (!all) return;
  const Council::Decision& decided = *all;
  stage_ = Stage::kApart;
  decision.planned = true;
  for (const Move& move : decided.moves)
    if (std::ranges::binary_search(own.own, move.subdomain, {}, &SubdomainLoad::id)) decision.moves.push_back(move);
  if (decided.coming.count > 0) promises_.push_back({decided.coming, situation.now});
  for (; early_ > 0 && !promises_.empty(); --early_) keep_promise();
  early_ = 0;
  changed_ = changed_ || !decision.moves.empty() || decided.coming.count > 0;
  if (is_logged()) {
    Deliberation plan{.subject = Deliberation::Subject::kPlan,
                      .verdict = decided.any_moves ? Verdict::kDone : Verdict::kSmallSaving};
    for (const Move& move : decision.moves)
      plan.moves.push_back({move.subdomain, self_, move.destination, Verdict::kDone});
    if (leads() || !plan.moves.empty()) note(std::move(plan));
  }
  if (!leads()) return;
  news_->assume(decided.states, situation.now);
  pace_.planned(situation.now, decided.any_moves);
}

// While work is on its way here, rank 0 assumes what was planned. From the call to the decision it gets no reports: it
// would take a report from before the decision for news.
void CollectiveConduct::report(const Situation& situation, Decision& decision) {
  if (waiting() || expects_work()) return;
  const double total = total_work(situation.own);
  if (!rule_.due(situation.now, total, situation.speed, changed_)) return;
  rule_.told(situation.now, total, situation.speed);
  changed_ = false;
  const LoadNews news = news_of(++reports_, situation, situation.own);
  if (!leads()) {
    decision.messages.push_back({kLeadingRank, news});
    return;
  }
  static_cast<void>(news_->hear(self_, news, situation.now));
  fresh_ = true;
}

Contribution CollectiveConduct::contribution(const Situation& situation) const {
  Contribution own{self_, {situation.speed, total_work(situation.own), situation.doubt, situation.free_memory}, {}, {}};
  for (const Promise& promise : promises_) {
    own.state.remaining += promise.coming.work;
    own.state.free_memory -= promise.coming.work;
  }
  own.own = states_of(self_, situation.own);
  for (const auto& [id, when] : came_) own.settled.push_back(id);
  return own;
}

// Do not wait forever for what a giver could not hand over after all.
void CollectiveConduct::forget_old(const Situation& situation) {
  const double now = situation.now;
  const double left = situation.speed > 0 ? total_work(situation.own) / situation.speed : options_.interval;
  const double rest = options_.rest_after_move(left);
  std::erase_if(came_, [&](const auto& entry) { return now - entry.second > rest; });
  while (!promises_.empty() && now > promises_.front().when + options_.patience()) promises_.pop_front();
}

}  // namespace driftmesh::balancer
