#include "balancer/planning_conduct.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "balancer/admissions.hpp"
#include "balancer/effort.hpp"
#include "balancer/mend_plan.hpp"
#include "balancer/partners.hpp"
#include "balancer/within_memory.hpp"

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
      rule_(options.gap, options.interval, options.change),
      start_(now),
      pace_(options, now) {
  if (policy_->placement() == Placement::kNeighbors || self == kLeadingRank)
    knowledge_.emplace(layout_, options.patience());
}

void PlanningConduct::receive(Rank source, Message advice, double now) {
  if (auto* const report = std::get_if<LoadReport>(&advice)) {
    if (!plans()) return;
    knowledge_->hear(source, *report, now);
    news_ = true;
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
    plan_seen_ = std::max(plan_seen_, plan.round);
    acted_ = true;
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
  knowledge_->hear(
      self_, {++reports_, plan_seen_, situation.speed, with_mentioned(own), situation.doubt, 0, situation.free_memory},
      now);
  const bool leads = policy_->placement() == Placement::kLeader;
  if (!news_ || !pace_.due(now)) return;
  // The first plan waits a little for the speeds of all ranks.
  if (leads && !knowledge_->complete() && now < start_ + options_.patience()) return;
  pace_.looked(now);
  decision.planned = true;
  LoadSnapshot snapshot = knowledge_->snapshot(now, leads);
  if (leads) be_sure_of_idle_ranks(snapshot);
  news_ = false;
  if (leads) {
    const double cost = pace_.cost_of_planning();
    const double whole = affords_whole(snapshot, situation) ? cost_of_whole(snapshot, situation) : 0;
    const double ahead = options_.time_ahead(ideal_time(snapshot), std::max(cost, whole));
    const Verdict verdict = outlook(snapshot, options_.worth, cost, ahead);
    news_ = verdict == Verdict::kTooEarly;  // it will be time without any
    if (verdict != Verdict::kDone) return;
  }
  const double rest = options_.rest_after_move(finishing_time(snapshot));
  std::erase_if(moved_, [&](const auto& move) { return now - move.second > rest; });
  price_moves(snapshot, options_.cost);
  for (SubdomainLoad& s : snapshot.subdomains)
    s.fixed = s.fixed || knowledge_->in_motion(s.id) || moved_.contains(s.id);
  const std::vector<Move> moves = worthwhile_plan(snapshot, situation);
  pace_.planned(now, !moves.empty() || news_);
  if (moves.empty()) return;
  advise(moves, snapshot, own, decision);
  knowledge_->expect(moves, snapshot, plans_, now);
  advised_now_ = true;
  for (const Move& move : moves) moved_[move.subdomain] = now;
}

/// The plan of the policy as far as it is worth its moves. If the policy offers single moves as well, a plan is asked
/// for only where some of those are worth making: where none is, what remains is too coarse for parts as well, or no
/// rank has memory.
std::vector<Move> PlanningConduct::worthwhile_plan(const LoadSnapshot& snapshot, const Situation& situation) {
  const bool leads = policy_->placement() == Placement::kLeader;
  const auto needed = [&](const std::vector<Move>& moves) {
    return worth_moving(leads ? snapshot : between(snapshot, self_, moves), moves, options_.cost, options_.worth);
  };
  if (!leads) {
    std::vector<Move> moves = policy_->plan(snapshot, self_);
    news_ = drop_early(moves, snapshot, self_, options_);  // it will be time for those without any
    return needed(moves);
  }
  const auto single = policy_->touch_up(snapshot);
  if (!single) return needed(policy_->plan(snapshot, self_));
  std::vector<Move> few = needed(*single);
  if (few.empty() || !affords_whole(snapshot, situation)) return few;
  const std::vector<Move> plan = policy_->plan(snapshot, self_);
  planned_whole_ = true;
  whole_at_ = situation.now;
  return plan == *single ? few : better_of(plan, few, snapshot);
}

/// A plan is made as a whole, since what makes it better than single moves would be lost in parts, or not at all: it is
/// mended, and must then end notably earlier than those, or as early with less border between ranks and not too many
/// moves. Otherwise the single moves are made, mended if that leaves less border.
std::vector<Move> PlanningConduct::better_of(const std::vector<Move>& plan, const std::vector<Move>& few,
                                             const LoadSnapshot& snapshot) {
  const double ideal = ideal_time(within_memory(snapshot)), singly = finish(snapshot, few);
  const auto worthwhile = [&](std::span<const Move> moves, std::size_t most, Kept kept) {
    return worth_moving(snapshot, mended(moves, snapshot, ideal, singly, most), options_.cost, options_.worth, kept);
  };
  const auto border = [&](const std::vector<Move>& moves) { return border_between_ranks(after(snapshot, moves)); };
  const double border_singly = border(few);

  std::vector<Move> whole = worthwhile(plan, most_moves(few), Kept::kAll);
  const double later = finish(snapshot, whole) - singly, border_whole = border(whole);
  const bool is_earlier = later < -options_.worth.gain * ideal;
  const bool is_as_early = later <= options_.worth.slack * ideal && whole.size() <= most_moves(few);
  const bool takes_whole = is_earlier || (is_as_early && border_whole < border_singly);
  note_comparison(0, border_whole, takes_whole);
  note_comparison(1, border_singly, !takes_whole);
  overruled_gain_ = takes_whole ? 0 : possible_gain(within_memory(snapshot));
  if (takes_whole) return whole;

  std::vector<Move> few_mended = worthwhile(few, few.size(), Kept::kNeeded);
  const double border_mended = border(few_mended);
  const bool takes_mended = !few_mended.empty() && border_mended < border_singly;
  note_comparison(0, border_mended, takes_mended);
  note_comparison(2, border_singly, !takes_mended);
  return takes_mended ? few_mended : few;
}

/// Seconds until all have finished what they then have.
double PlanningConduct::finish(const LoadSnapshot& snapshot, std::span<const Move> moves) const {
  return std::ranges::max(finishing_times(snapshot, moves, options_.cost));
}

/// The plan, so that it ends about as early as single moves do, with no more moves than it may have then. One that ends
/// notably earlier may have any number.
std::vector<Move> PlanningConduct::mended(std::span<const Move> plan, const LoadSnapshot& snapshot, double ideal,
                                          double singly, std::size_t most_moves) const {
  const double slack = options_.worth.slack * ideal, as_made = finish(snapshot, plan);
  const bool is_better = as_made < singly - options_.worth.gain * ideal;
  const double latest = singly + (1 - 1e-9) * slack;  // sums are rounded
  return mend_plan(snapshot, plan, options_.cost,
                   {std::min(std::max(as_made, ideal + slack), latest), latest, is_better ? SIZE_MAX : most_moves});
}

std::size_t PlanningConduct::most_moves(std::span<const Move> few) const {
  const double most = policy_->most_moves() * static_cast<double>(few.size());
  return most < 1e15 ? static_cast<std::size_t>(most) : SIZE_MAX;
}

/// Not if an even load would gain less than planning takes, or less than when single moves were preferred to the last
/// whole plan: what was no use with more to gain will be none with less. Nor if it takes more than an eighth of the
/// time that is left: it would have to be begun so early (see time_ahead) that forecasts were of no use.
bool PlanningConduct::affords_whole(const LoadSnapshot& snapshot, const Situation& situation) const {
  const double cost = cost_of_whole(snapshot, situation);
  if (situation.now < next_whole_ || 8 * cost > ideal_time(snapshot)) return false;
  return possible_gain(within_memory(snapshot)) > std::max(cost, overruled_gain_);
}

/// What a whole plan takes, in seconds, mended: what one has taken, if that is more than expected.
double PlanningConduct::cost_of_whole(const LoadSnapshot& snapshot, const Situation& situation) const {
  const double slower = situation.speed > 0 ? options_.reference_speed / situation.speed : 1;
  const double parts = policy_->planning_seconds(snapshot);
  const double mending = parts > 0 ? PlanningCosts{}.seconds(effort_of_mending(snapshot)) : 0;
  return std::max(whole_cost_, slower * (parts + mending));
}

// A plan that took long has just been sent, and is not to be forgotten before it can have been carried out.
void PlanningConduct::took(double seconds) {
  if (std::exchange(advised_now_, false)) knowledge_->put_off(plans_, seconds);
  if (!std::exchange(planned_whole_, false)) return pace_.took(seconds);
  whole_cost_ = std::max(whole_cost_, seconds);
  next_whole_ = whole_at_ + seconds / options_.overhead;
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
      plan_seen_ = plans_;
      acted_ = true;
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
  const auto is_new = [&](const auto& load) { return !std::binary_search(told_.begin(), told_.end(), load.subdomain); };
  const bool changed = acted_ || !mentioned_.empty() || std::any_of(own.begin(), own.end(), is_new);
  const double total = total_work(own);
  if (!rule_.due(situation.now, total, situation.speed, changed)) return;
  rule_.told(situation.now, total, situation.speed);
  acted_ = false;
  told_.clear();
  for (const auto& load : own) told_.push_back(load.subdomain);
  std::sort(told_.begin(), told_.end());
  news_ = true;  // also to this rank, if it plans
  const LoadReport list{++reports_,      plan_seen_, situation.speed,      with_mentioned(own),
                        situation.doubt, 0,          situation.free_memory};
  const LoadReport sum{list.round, list.plan, list.speed,      std::exchange(mentioned_, {}),
                       list.doubt, total,     list.free_memory};
  const std::vector<Rank> listeners = audience(own);
  for (const Rank rank : listeners)
    if (rank != self_) decision.messages.push_back({rank, list});
  if (policy_->placement() != Placement::kNeighbors) return;
  for (const Rank rank : distant_partners(self_, layout_->ranks))
    if (!std::ranges::binary_search(listeners, rank)) decision.messages.push_back({rank, sum});
}

// The planner of a move must learn that it was made, even if the subdomain has been finished since, and that it was not
// made because the subdomain was finished before: otherwise it counts on that work for the destination.
PlanningConduct::Loads PlanningConduct::with_mentioned(Loads own) const {
  for (const ReportedLoad& load : mentioned_)
    if (std::none_of(own.begin(), own.end(), [&](const auto& l) { return l.subdomain == load.subdomain; }))
      own.push_back(load);
  return own;
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
