#include "balancer/planning_conduct.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "balancer/admissions.hpp"
#include "balancer/snapshot/partners.hpp"
#include "balancer/trigger/outlook.hpp"

namespace driftmesh::balancer {
namespace {

/// The snapshot with work only on `self` and on the destinations of `moves`: what one rank can judge on its own.
LoadSnapshot between(LoadSnapshot snapshot, Rank self, std::span<const Move> moves) {
  IdVector<Rank, bool> concerned(snapshot.ranks.size(), false);
  concerned[self] = true;
  for (const Move& move : moves) concerned[move.destination] = true;
  for (const Rank r : ids_of(concerned))
    if (!concerned[r]) snapshot.ranks[r].remaining = 0;
  return snapshot;
}

/// How many times a rank may be given the same without being asked, if each plans with its partners: a few times by
/// each that may, which are the distant ones and about as many as a rank touches.
double unaware_partners(Rank self, std::int32_t ranks) {
  constexpr std::size_t kTouching = 6;
  constexpr double kTimes = 4;
  const std::size_t partners = distant_partners(self, ranks).size() + kTouching;
  return kTimes * static_cast<double>(std::min(to_index(ranks) - 1, partners));
}

/// Drops moves to ranks that have work for long: where several ranks give to the same one without knowing of each
/// other, and forecasts change, they would give it too much, too often. Returns whether there are any.
bool drop_early(std::vector<Move>& moves, const LoadSnapshot& snapshot, Rank self, const ControllerOptions& options) {
  const IdVector<Rank, double> speeds = assumed_speeds(snapshot.ranks);
  const auto time = [&](Rank r) { return snapshot.ranks[r].remaining / speeds[r]; };
  const double ahead = 2 * options.time_ahead(time(self), 0);  // it takes more than one step
  return std::erase_if(moves, [&](const Move& move) { return time(move.destination) > ahead; }) > 0;
}

}  // namespace

PlanningConduct::PlanningConduct(Rank self, std::shared_ptr<const Layout> layout, std::shared_ptr<const Policy> policy,
                                 const ControllerOptions& options, double now)
    : self_(self),
      layout_(std::move(layout)),
      policy_(std::move(policy)),
      options_(options),
      reporter_(options),
      start_(now),
      pace_(options, now),
      choice_(policy_, options) {
  if (policy_->placement() == Placement::kNeighbors || self == kLeadingRank)
    knowledge_.emplace(layout_, options.patience());
}

void PlanningConduct::receive(Rank source, Message advice, double now) {
  if (auto* const report = std::get_if<LoadReport>(&advice)) {
    if (!plans()) return;
    knowledge_->hear(source, *report, now);
    state_ = State::kNews;
  } else if (auto* const plan = std::get_if<Plan>(&advice)) {
    advised_.push_back(std::move(*plan));
  }
}

Decision PlanningConduct::think(const Situation& situation) {
  Decision decision;
  Loads own(situation.own.begin(), situation.own.end());
  follow_advice(situation, own, decision);
  if (plans()) plan(situation, own, decision);
  report(situation, own, decision);
  return decision;
}

void PlanningConduct::follow_advice(const Situation& situation, Loads& own, Decision& decision) {
  for (const Plan& plan : std::exchange(advised_, {})) {
    reporter_.acted_on(plan.round);
    Deliberation followed{.subject = Deliberation::Subject::kAdvice};
    for (const Move& move : plan.moves) {
      const Verdict verdict = judge(move, situation, own);
      followed.moves.push_back({move.subdomain, self_, move.destination, verdict});
      const bool asks = std::ranges::find(plan.ask, move.destination) != plan.ask.end();
      if (verdict == Verdict::kDone && take_out(own, move.subdomain))
        (asks ? decision.asks : decision.moves).push_back(move);
      if (verdict == Verdict::kGone) gone(move.subdomain);
    }
    note(std::move(followed));
  }
}

/// Whether a move that is advised still makes sense.
Verdict PlanningConduct::judge(const Move& move, const Situation& situation, const Loads& own) const {
  const auto load = std::ranges::find(own, move.subdomain, &ReportedLoad::subdomain);
  if (load == own.end()) return Verdict::kGone;
  if (move.destination == self_) return Verdict::kInvalid;
  const bool nearly_done =
      situation.speed > 0 && load->remaining / situation.speed <= options_.cost.for_giver(load->bytes, situation.speed);
  return nearly_done ? Verdict::kCostsMore : Verdict::kDone;
}

void PlanningConduct::plan(const Situation& situation, Loads& own, Decision& decision) {
  const double now = situation.now;
  knowledge_->hear(self_, reporter_.current(situation, own), now);
  const bool leads = policy_->placement() == Placement::kLeader;
  if (state_ != State::kNews || !pace_.due(now)) return;
  // The first plan waits a little for the speeds of all ranks.
  if (leads && !knowledge_->complete() && now < start_ + options_.patience()) return;
  pace_.looked(now);
  decision.planned = true;
  LoadSnapshot snapshot = knowledge_->snapshot(now, leads);
  if (leads) be_sure_of_idle_ranks(snapshot);
  state_ = State::kUpToDate;
  if (leads) {
    const double cost = pace_.cost_of_planning();
    const double whole = choice_.affords_whole(snapshot, situation) ? choice_.cost_of_whole(snapshot, situation) : 0;
    const double ahead = options_.time_ahead(ideal_time(snapshot), std::max(cost, whole));
    const Verdict verdict = outlook(snapshot, options_.worth, cost, ahead);
    if (verdict == Verdict::kTooEarly) state_ = State::kNews;  // it will be time without any
    if (verdict != Verdict::kDone) return;
  }
  const double rest = options_.rest_after_move(finishing_time(snapshot));
  std::erase_if(moved_, [&](const auto& move) { return now - move.second > rest; });
  price_moves(snapshot, options_.cost);
  for (SubdomainLoad& s : snapshot.subdomains)
    s.fixed = s.fixed || knowledge_->in_motion(s.id) || moved_.contains(s.id);
  const std::vector<Move> moves = leads ? choice_.choose(snapshot, situation) : plan_with_partners(snapshot);
  pace_.planned(now, !moves.empty() || state_ == State::kNews);
  if (moves.empty()) return;
  advise(moves, snapshot, own, decision);
  knowledge_->expect(moves, snapshot, plans_, now);
  advice_ = Advice::kJustSent;
  for (const Move& move : moves) moved_[move.subdomain] = now;
}

/// What this rank, which plans for its own, can give to its partners.
std::vector<Move> PlanningConduct::plan_with_partners(const LoadSnapshot& snapshot) {
  std::vector<Move> moves = policy_->plan(snapshot, self_);
  // It will be time for those without any news.
  if (drop_early(moves, snapshot, self_, options_)) state_ = State::kNews;
  return worth_moving(between(snapshot, self_, moves), moves, options_.cost, options_.worth);
}

// A plan that took long has just been sent, and is not to be forgotten before it can have been carried out.
void PlanningConduct::took(double seconds) {
  if (std::exchange(advice_, Advice::kSettled) == Advice::kJustSent) knowledge_->put_off(plans_, seconds);
  if (!choice_.took(seconds)) pace_.took(seconds);
}

void PlanningConduct::advise(std::span<const Move> moves, const LoadSnapshot& snapshot, Loads& own,
                             Decision& decision) {
  ++plans_;
  const std::vector<Rank> asked = to_be_asked(moves, snapshot);
  const auto asks = [&](const Move& move) { return std::ranges::binary_search(asked, move.destination); };
  std::map<Rank, Plan> of_rank;
  for (const Move& move : moves) {
    const Rank owner = find(snapshot, move.subdomain)->owner;
    if (owner != self_) {
      Plan& plan = of_rank[owner];
      plan.round = plans_;
      plan.moves.push_back(move);
      if (asks(move) && std::ranges::find(plan.ask, move.destination) == plan.ask.end())
        plan.ask.push_back(move.destination);
    } else if (take_out(own, move.subdomain)) {
      (asks(move) ? decision.asks : decision.moves).push_back(move);
      reporter_.acted_on(plans_);
    }
  }
  for (auto& [rank, plan] : of_rank) decision.messages.push_back({rank, std::move(plan)});
}

std::vector<Rank> PlanningConduct::to_be_asked(std::span<const Move> moves, const LoadSnapshot& snapshot) const {
  const bool leads = policy_->placement() == Placement::kLeader;
  return short_of_memory(snapshot, moves, knowledge_->on_its_way(),
                         leads ? kUnawareGivers : unaware_partners(self_, layout_->ranks));
}

void PlanningConduct::report(const Situation& situation, const Loads& own, Decision& decision) {
  const std::optional<LoadReporter::Reports> reports = reporter_.due(situation, own);
  if (!reports) return;
  state_ = State::kNews;  // news for this rank, too, if it plans
  const std::vector<Rank> listeners = audience(own);
  for (const Rank rank : listeners)
    if (rank != self_) decision.messages.push_back({rank, reports->list});
  if (policy_->placement() != Placement::kNeighbors) return;
  for (const Rank rank : distant_partners(self_, layout_->ranks))
    if (!std::ranges::binary_search(listeners, rank)) decision.messages.push_back({rank, reports->sum});
}

std::vector<Rank> PlanningConduct::audience(const Loads& own) {
  if (policy_->placement() == Placement::kLeader) return {kLeadingRank};
  if (own.empty()) return audience_;  // its idleness matters to the ranks it touched last
  audience_.clear();
  for (const auto& load : own)
    for (const Neighbor& n : (*layout_)[load.subdomain].neighbors)
      audience_.push_back(knowledge_->owner_of(n.subdomain));
  std::sort(audience_.begin(), audience_.end());
  audience_.erase(std::unique(audience_.begin(), audience_.end()), audience_.end());
  return audience_;
}

}  // namespace driftmesh::balancer
