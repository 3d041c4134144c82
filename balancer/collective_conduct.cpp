#include "balancer/collective_conduct.hpp"

#include <algorithm>
#include <utility>

namespace driftmesh::balancer {
namespace {

constexpr Rank kLeader = 0;
constexpr double kPatience = 3;  // intervals that promised work is waited for

}  // namespace

CollectiveConduct::CollectiveConduct(Rank self, std::shared_ptr<const Layout> layout,
                                     std::shared_ptr<const Policy> policy, const ControllerOptions& options,
                                     Council& council, double now)
    : self_(self),
      layout_(std::move(layout)),
      policy_(std::move(policy)),
      options_(options),
      council_(council),
      rule_(options.gap, options.interval, options.change),
      start_(now),
      pace_(options, now) {
  if (self == kLeader) news_.emplace(*layout_, now);
}

void CollectiveConduct::receive(Rank source, const protocol::Message& advice, double now) {
  if (const auto* const news = std::get_if<protocol::LoadNews>(&advice)) {
    if (!leads()) return;
    static_cast<void>(news_->hear(source, *news, now));
    fresh_ = true;
  } else if (const auto* const step = std::get_if<protocol::JointRound>(&advice)) {
    take_step(*step);
  }
}

// A start comes after all have answered the call, so it cannot overtake it.
void CollectiveConduct::take_step(const protocol::JointRound& step) {
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
  if (coming_.count == 0) return;
  coming_.work -= coming_.work / coming_.count;
  --coming_.count;
}

Decision CollectiveConduct::think(const Situation& situation) {
  Decision decision;
  forget_old(situation.now);
  if (stage_ == Stage::kStarted) decide(situation, decision);
  if (leads() && stage_ == Stage::kApart) call(situation, decision);
  if (stage_ == Stage::kCalled) answer(situation, decision);
  if (leads() && stage_ == Stage::kReady && ready_ == layout_->ranks) start(decision);
  report(situation, decision);
  return decision;
}

void CollectiveConduct::say_to_all(Step step, Decision& decision) const {
  for (Rank r = 0; r < layout_->ranks; ++r)
    if (r != self_) decision.messages.push_back({r, protocol::JointRound{round_, step}});
}

void CollectiveConduct::call(const Situation& situation, Decision& decision) {
  const double now = situation.now;
  if (!fresh_ || !pace_.due(now) || expects_work(now)) return;
  // The first round waits a little for all to say how fast they are.
  if (!news_->complete() && now < start_ + options_.interval) return;
  fresh_ = false;
  pace_.looked(now);
  LoadSnapshot sums;
  sums.ranks = news_->states(now);
  if (!may_gain(sums, options_.worth, pace_.cost_of_planning())) return;
  ++round_;
  ready_ = 0;
  stage_ = Stage::kCalled;
  say_to_all(Step::kCall, decision);
}

void CollectiveConduct::answer(const Situation& situation, Decision& decision) {
  council_.announce(round_, contribution(situation));
  stage_ = Stage::kReady;
  if (leads())
    ++ready_;
  else
    decision.messages.push_back({kLeader, protocol::JointRound{round_, Step::kReady}});
}

// Rank 0 itself decides when it thinks next: what it says now must leave before it waits for those who are to hear it.
void CollectiveConduct::start(Decision& decision) {
  say_to_all(Step::kStart, decision);
  stage_ = Stage::kStarted;
}

void CollectiveConduct::decide(const Situation& situation, Decision& decision) {
  const Council::Decision decided = council_.decide(round_, contribution(situation));
  stage_ = Stage::kApart;
  decision.planned = true;
  const auto is_here = [&](const Move& move) {
    return std::any_of(situation.own.begin(), situation.own.end(),
                       [&](const auto& load) { return load.subdomain == move.subdomain; });
  };
  for (const Move& move : decided.moves)
    if (is_here(move)) decision.moves.push_back(move);
  coming_ = decided.coming;
  promised_ = situation.now;
  changed_ = true;
  if (!leads()) return;
  news_->assume(decided.states, situation.now);
  pace_.planned(situation.now, decided.any_moves);
}

// While work is on its way here, rank 0 reckons with what was planned.
void CollectiveConduct::report(const Situation& situation, Decision& decision) {
  if (expects_work(situation.now)) return;
  const double total = total_work(situation.own);
  if (!rule_.due(situation.now, total, situation.speed, changed_)) return;
  rule_.told(situation.now, total, situation.speed);
  changed_ = false;
  const protocol::LoadNews news = news_of(++reports_, situation.speed, situation.own);
  if (!leads()) {
    decision.messages.push_back({kLeader, news});
    return;
  }
  static_cast<void>(news_->hear(self_, news, situation.now));
  fresh_ = true;
}

Contribution CollectiveConduct::contribution(const Situation& situation) const {
  Contribution own{self_, {situation.speed, total_work(situation.own)}, {}, {}};
  if (expects_work(situation.now)) own.state.remaining += coming_.work;
  for (const protocol::SubdomainLoad& load : situation.own)
    own.own.push_back({load.subdomain, self_, load.remaining, load.bytes, static_cast<std::int32_t>(own.own.size())});
  std::sort(own.own.begin(), own.own.end(),
            [](const SubdomainState& a, const SubdomainState& b) { return a.id < b.id; });
  for (const auto& [id, when] : came_) own.settled.push_back(id);
  return own;
}

// What the giver could not hand over after all is not waited for without end.
bool CollectiveConduct::expects_work(double now) const {
  return coming_.count > 0 && now <= promised_ + kPatience * options_.interval;
}

void CollectiveConduct::forget_old(double now) {
  std::erase_if(came_, [&](const auto& entry) { return now - entry.second > options_.interval; });
}

}  // namespace driftmesh::balancer
