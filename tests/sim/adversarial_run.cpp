#include "sim/adversarial_run.hpp"

#include <algorithm>
#include <exception>

#include "balancer/policies/policy_factory.hpp"
#include "driftmesh/error.hpp"
#include "mesh/digest.hpp"
#include "protocol/counter_sum.hpp"
#include "runtime/plan_run.hpp"
#include "sim/mesh_oracles.hpp"
#include "support/simulated_run.hpp"

namespace driftmesh::sim {

AdversarialRun::AdversarialRun(const Scenario& scenario, Domain& domain, const Wrap& wrap, const protocol::Rules& rules)
    : scenario_(scenario),
      domain_(domain),
      mover_(scenario),
      network_(scenario.ranks, adversary()),
      rules_(rules, scenario.arity),
      stale_locations_{std::mt19937_64(scenario.seed), {}},
      witness_(scenario.ranks, to_index(scenario.subdomains), [this] { return is_quiet(); }) {
  make_plan();
  for (const Rank r : first_ids<Rank>(scenario.ranks))
    loops_.push_back(std::make_unique<SubdomainLoop>(transport_of(r, wrap), plan_, costs_of(r), RankLoop::Observers{},
                                                     nullptr, rules_));
  for (const Rank r : ids_of(loops_)) {
    if (scenario.crew == 0) break;
    crews_.push_back(std::make_unique<testing::SimulatedCrew>(scenario.crew, scenario.seed + to_index(r)));
    loops_[r]->hire(*crews_.back());
  }
  arrivals_seen_.resize(loops_.size());
  if (scenario.short_of_memory && plan_.layout) limit_memory();
}

Outcome AdversarialRun::run() {
  if (!go()) return std::move(outcome_);
  count();
  say("no message lost", lost_messages());
  say("tokens have the right count and color", witness_.token_problem());
  say("no SPLIT makes more hops than its subdomain", witness_.hops_problem());
  say("each question for memory has an answer",
      outcome_.effects.questions == outcome_.effects.answers ? "" : "some have none, or several");
  say("one live owner", owners_at_the_end());
  if (!outcome_.failure().empty()) return std::move(outcome_);
  const std::vector<const Subdomain*> all = subdomains_awake();
  const auto problems = testing::conformity_problems(plan_.decomposition, all);
  say("both sides of each edge hold the same points", problems.empty() ? "" : problems.front());
  say("points on interfaces are announced once or twice", announcements(all));
  say("the verifier accepts the mesh", verdict_on_mesh(domain_, plan_.decomposition, all));
  compare_digest(all);
  return std::move(outcome_);
}

void AdversarialRun::make_plan() {
  plan_.decomposition = domain_.cut(scenario_.subdomains);
  const Rank only = mover_.any_rank();
  for (std::size_t s = 0; s < plan_.decomposition.size(); ++s)
    plan_.owners.push_back(scenario_.lopsided ? only : mover_.any_rank());
  plan_.bounds = domain_.bounds();
  context_ = {&plan_.decomposition, plan_.bounds, scenario_.presplit};
  plan_.presplit = scenario_.presplit;
  plan_.work.aggregation = scenario_.aggregation;
  plan_.work.slice = scenario_.slice;
  plan_.work.order = scenario_.order;
  plan_.work.sleep = scenario_.sleep;
  if (!scenario_.balanced()) return;
  plan_.balancing.policy = scenario_.mover;
  if (scenario_.mover == "stealing") plan_.balancing.parameters["low-water"] = "20";
  plan_.balancing.options.look = 3;
  plan_.balancing.options.gap = 10;
  plan_.balancing.options.interval = 300;
  plan_.balancing.options.cost.latency = 0.1;
  prepare_balancing(plan_, scenario_.ranks, balancer::make_policy);
}

CostModel AdversarialRun::costs_of(Rank r) const {
  CostModel costs;
  costs.start = 1;
  costs.prepared = 0;
  costs.point = 0.1 * static_cast<double>(1 + (scenario_.seed + 7 * static_cast<std::uint64_t>(to_int(r))) % 10);
  return costs;
}

// Chance moves subdomains regardless of it, and so ranks may well have more than they have room for.
void AdversarialRun::limit_memory() {
  double total = 0;
  for (const balancer::Layout::Subdomain& s : plan_.layout->subdomains) total += s.predicted;
  for (const Rank r : ids_of(loops_)) {
    const double room = total / static_cast<double>(1 + (scenario_.seed + to_index(r)) % 4);
    loops_[r]->limit_memory([room, loop = loops_[r].get()] { return room - static_cast<double>(loop->triangles()); });
  }
}

protocol::Adversary AdversarialRun::adversary() {
  protocol::Adversary result = scenario_.adversary;
  const auto after = [ranks = static_cast<std::uint64_t>(scenario_.ranks)](std::uint64_t steps) {
    return [least = steps * ranks](const protocol::Parcel& parcel, std::uint64_t step) {
      return step < parcel.sent + least ? protocol::Urgency::kNotYet : protocol::Urgency::kAnyTime;
    };
  };
  switch (scenario_.mischief) {
    case Mischief::kNone:
    case Mischief::kStaleLocations:
      break;
    case Mischief::kRacingHandOffs:
      result.urgency = [late = after(30)](const protocol::Parcel& parcel, std::uint64_t step) {
        if (!is<protocol::HandOff>(parcel.bytes)) return protocol::Urgency::kAnyTime;
        return parcel.serial % 2 == 0 ? protocol::Urgency::kFirst : late(parcel, step);
      };
      break;
    case Mischief::kLateLocations:
      result.urgency = [this](const protocol::Parcel& parcel, std::uint64_t) {
        const bool waits = is<protocol::LocationUpdate>(parcel.bytes) && !is_quiet();
        return waits ? protocol::Urgency::kNotYet : protocol::Urgency::kAnyTime;
      };
      break;
    case Mischief::kLateAdvice:
      result.urgency = [late = after(40)](const protocol::Parcel& parcel, std::uint64_t step) {
        const bool advice = is_advice<balancer::Plan>(parcel.bytes) || is_advice<balancer::WorkRequest>(parcel.bytes) ||
                            is_advice<balancer::WorkAnswer>(parcel.bytes) ||
                            is_advice<balancer::Admission>(parcel.bytes);
        return advice ? late(parcel, step) : protocol::Urgency::kAnyTime;
      };
      break;
  }
  return result;
}

protocol::Transport& AdversarialRun::transport_of(Rank r, const Wrap& wrap) {
  const auto loop = [this, r]() -> const SubdomainLoop& { return *loops_[r]; };
  protocol::Transport* transport = &network_.transport(r);
  const auto put_on = [&](std::unique_ptr<protocol::Transport> layer) {
    layers_.push_back(std::move(layer));
    transport = layers_.back().get();
  };
  if (scenario_.mischief == Mischief::kStaleLocations)
    put_on(std::make_unique<StaleLocationTransport>(*transport, stale_locations_));
  put_on(std::make_unique<WitnessedTransport>(
      *transport, witness_, [loop](SubdomainId s) { return loop().subdomains().contains(s); },
      [loop]() -> const protocol::ProtocolCounters& { return loop().protocol().counters(); }));
  if (wrap) put_on(wrap(*transport, loop));
  return *transport;
}

bool AdversarialRun::go() {
  IdVector<Rank, protocol::RankStep> steps;
  for (const Rank r : first_ids<Rank>(scenario_.ranks)) steps.push_back([this, r] { return step(r); });
  try {
    const protocol::RunResult result = network_.run(steps);
    outcome_.steps = result.steps;
    outcome_.network = network_.counters();
    say("the run ends", result.end == protocol::RunEnd::kFinished  ? ""
                        : result.end == protocol::RunEnd::kStalled ? "stalled: " + describe()
                                                                   : "does not end: " + describe());
    say("termination in time", "");
  } catch (const Wrong& wrong) {
    outcome_.verdicts.push_back(wrong.verdict);
  } catch (const std::exception& error) {
    say("no error", error.what());
  }
  return outcome_.failure().empty();
}

protocol::StepResult AdversarialRun::step(Rank r) {
  SubdomainLoop& loop = *loops_[r];
  mover_.before_step(loop, r);
  const protocol::StepResult result = loop.step();
  watch_owners(r);
  watch_termination();
  return result;
}

void AdversarialRun::watch_owners(Rank r) {
  const SubdomainLoop& loop = *loops_[r];
  const std::int64_t arrivals = loop.protocol().counters().arrivals;
  std::int64_t& seen = arrivals_seen_[r];
  if (std::exchange(seen, arrivals) == arrivals) return;
  for (const auto& [id, subdomain] : loop.subdomains())
    for (const auto& other : loops_)
      if (other.get() != &loop && other->subdomains().contains(id))
        throw Wrong{{"one live owner", "subdomain " + to_string(id) + " lives on two ranks"}};
}

void AdversarialRun::watch_termination() {
  const auto wrong = [](const char* what) { throw Wrong{{"termination in time", what}}; };
  if (work_anywhere()) {
    if (quiet_since_) wrong("new work after all was done");
    for (const auto& loop : loops_)
      if (loop->protocol().phase() != protocol::Termination::Phase::kWorking) wrong("too early");
    return;
  }
  const std::uint64_t rounds = loops_.front()->protocol().termination().rounds();
  if (!quiet_since_) quiet_since_ = rounds;
  if (rounds > *quiet_since_ + 2) wrong("too late");
  outcome_.late_rounds = rounds - *quiet_since_;
}

bool AdversarialRun::work_anywhere() {
  for (const auto& loop : loops_)
    if (loop->at_work()) return true;
  for (const Rank r : first_ids<Rank>(scenario_.ranks))
    for (const auto& parcel : network_.under_way(r))
      if (protocol::traffic_of(parcel.source, parcel.bytes) == protocol::Traffic::kWork) return true;
  return false;
}

void AdversarialRun::count() {
  for (const auto& crew : crews_) outcome_.shifts += crew->performed();
  for (const auto& loop : loops_) outcome_.counters += loop->protocol().counters();
  outcome_.effects = mover_.effects();
  outcome_.effects += witness_.effects();
  if (scenario_.balanced()) outcome_.effects.by_policy = outcome_.counters.hand_offs - outcome_.effects.by_chance;
  outcome_.effects.starved = static_cast<std::int64_t>(network_.counters().starved);
}

std::string AdversarialRun::lost_messages() const {
  const protocol::ProtocolCounters& c = outcome_.counters;
  if (network_.in_flight() != 0) return std::to_string(network_.in_flight()) + " messages are still in flight";
  if (c.splits_sent != c.splits_handled)
    return std::to_string(c.splits_sent) + " SPLITs were sent, " + std::to_string(c.splits_handled) + " handled";
  if (c.hand_offs != c.arrivals)
    return std::to_string(c.hand_offs) + " subdomains were given away, " + std::to_string(c.arrivals) + " arrived";
  return {};
}

/// A side announces each point that it makes, and no other, so a point is announced by one side or both.
std::string AdversarialRun::announcements(const std::vector<const Subdomain*>& all) const {
  if (scenario_.presplit) return {};  // there are points that both sides know from the start
  std::int64_t points = 0, announced = 0;
  for (const Subdomain* s : all) {
    const SubdomainMesh& part = s->mesh();
    for (const Subsegment& segment : part.mesh.subsegments) {
      const Decomposition::Root& root = plan_.decomposition.roots[part.roots[segment.root]];
      const bool interface = root.right != kNoSubdomain && root.right != root.left;
      points += !segment.is_leaf() && interface && root.left == s->id() ? 1 : 0;
    }
  }
  for (const auto& loop : loops_) announced += loop->interface_splits();
  const std::int64_t sent = outcome_.counters.splits_sent;
  if (points <= announced && announced <= 2 * points && sent <= announced) return {};
  return std::to_string(points) + " points, " + std::to_string(announced) + " announced, " + std::to_string(sent) +
         " sent";
}

std::string AdversarialRun::owners_at_the_end() const {
  IdVector<SubdomainId, int> owners(plan_.decomposition.size());
  for (const auto& loop : loops_)
    for (const SubdomainId s : ids_of(owners)) {
      const bool here = loop->subdomains().contains(s);
      owners[s] += here ? 1 : 0;
      if (here != loop->protocol().holds(s)) return "the directory of a rank is wrong about subdomain " + to_string(s);
    }
  for (const SubdomainId s : ids_of(owners))
    if (owners[s] != 1) return "subdomain " + to_string(s) + " has " + std::to_string(owners[s]) + " owners";
  return {};
}

void AdversarialRun::compare_digest(const std::vector<const Subdomain*>& all) {
  for (const Subdomain* s : all) {
    outcome_.digest += mesh_digest(s->mesh().mesh);
    outcome_.triangles += s->triangles();
  }
  if (!scenario_.presplit) return;
  const auto expected = domain_.digest_alone(scenario_.subdomains);
  if (!expected) return;
  outcome_.digest_compared = true;
  say("presplit interfaces need no SPLIT", outcome_.counters.splits_sent == 0 ? "" : "some were sent");
  say("the same mesh as from every other run", *expected == outcome_.digest ? "" : "its digest differs");
}

std::vector<const Subdomain*> AdversarialRun::subdomains_awake() {
  std::vector<const Subdomain*> all;
  for (const auto& loop : loops_)
    for (const auto& [id, subdomain] : loop->subdomains()) {
      all.push_back(&subdomain);
      if (!subdomain.dormant()) continue;
      copies_.push_back(Subdomain::unpack(subdomain.pack(), context_));
      copies_.back().wake();
      all.back() = &copies_.back();
    }
  outcome_.asleep = static_cast<std::int64_t>(copies_.size());
  std::sort(all.begin(), all.end(), [](const Subdomain* a, const Subdomain* b) { return a->id() < b->id(); });
  return all;
}

std::string AdversarialRun::describe() const {
  std::string text;
  for (const auto& loop : loops_)
    if (!loop->protocol().finished()) text += (text.empty() ? "" : "; ") + loop->protocol().describe();
  return text;
}

}  // namespace driftmesh::sim
