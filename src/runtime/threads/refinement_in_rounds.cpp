#include "runtime/threads/refinement_in_rounds.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <map>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <tuple>
#include <utility>

#include "protocol/threads/thread_network.hpp"
#include "runtime/coupling.hpp"
#include "runtime/plan_run.hpp"
#include "runtime/rank_loop.hpp"
#include "runtime/subdomain_loop.hpp"
#include "runtime/threads/few_threads.hpp"

namespace driftmesh {
namespace {

void add(RankOutcome& sum, const RankOutcome& round) {
  const auto add_to = [&](auto RankTimes::*kind) { sum.times.*kind += round.times.*kind; };
  for (const auto kind :
       {&RankTimes::computing, &RankTimes::sending, &RankTimes::polling, &RankTimes::balancing, &RankTimes::idle})
    add_to(kind);
  sum.counters.hand_offs += round.counters.hand_offs;
  sum.counters.hand_off_bytes += round.counters.hand_off_bytes;
  sum.counters.arrivals += round.counters.arrivals;
  sum.triangles = round.triangles;
  sum.subdomains = round.subdomains;
  sum.interface_splits += round.interface_splits;
  sum.messages += round.messages;
  sum.message_bytes += round.message_bytes;
}

}  // namespace

/// A point that a subdomain has put on its border, for the subdomain on the other side.
struct RefinementInRounds::Told {
  SubdomainId to{};
  SplitPoint<GlobalRootId> split;
  [[nodiscard]] auto key() const { return std::tuple(to, split.root, split.path); }
  friend bool operator<(const Told& a, const Told& b) { return a.key() < b.key(); }
  friend bool operator==(const Told& a, const Told& b) { return a.key() == b.key(); }
};

/// Tells nobody within a round, and notes in `told` what is to be told after it.
class RefinementInRounds::ToldLater final : public Coupling {
 public:
  ToldLater(const Decomposition& decomposition, std::vector<Told>& told) : decomposition_(decomposition), told_(told) {}

  std::optional<SubdomainId> to_tell(SubdomainId from, const SplitPoint<GlobalRootId>& split) override {
    told_.push_back({decomposition_.roots[split.root].across_from(from), split});
    return std::nullopt;
  }
  [[nodiscard]] std::int32_t roots() const override { return 0; }

 private:
  const Decomposition& decomposition_;
  std::vector<Told>& told_;
};

/// One round, or a part of it between two fences, with a loop for each thread.
class RefinementInRounds::Round {
 public:
  Round(RefinementInRounds& all, LoopPlan plan)
      : all_(all),
        plan_(std::move(plan)),
        network_(static_cast<std::int32_t>(all.held_.size())),
        ranks_(all.held_.size()) {
    for (const Rank r : ids_of(ranks_)) {
      OneRank& rank = ranks_[r];
      if (plan_.work.decoupled)
        rank.coupling = coupling_of(all.plan_);
      else
        rank.coupling = std::make_unique<ToldLater>(all.plan_.decomposition, rank.told);
      rank.loop.emplace(network_.transport(r), plan_, all.held_[r], *rank.coupling, CostModel{}, observers(r));
      rank.triangles = rank.loop->triangles();
    }
  }

  void run() {
    std::vector<std::thread> others;
    try {
      for (const Rank r : ids_of(ranks_))
        if (r != kCalling) others.emplace_back([this, r] { run_rank(r); });
      run_rank(kCalling);
    } catch (const std::system_error&) {  // thrown by the constructor of a thread
      failed_ = true;
      ranks_[kCalling].failure = std::make_exception_ptr(too_few_threads(others.size() + 1, ranks_.size()));
    }
    for (std::thread& other : others) other.join();
    for (const OneRank& rank : ranks_)
      if (rank.failure) std::rethrow_exception(rank.failure);
  }

  /// Adds what is to be told across borders, by who has put it there.
  void add_told(std::map<SubdomainId, std::vector<Told>>& all) const {
    const Decomposition& d = all_.plan_.decomposition;
    for (const OneRank& rank : ranks_)
      for (const Told& t : rank.told) all[d.roots[t.split.root].across_from(t.to)].push_back(t);
  }

  [[nodiscard]] RankOutcome outcome(Rank r) const { return ranks_[r].loop->outcome(); }

 private:
  static constexpr Rank kCalling{0};  // the rank of the calling thread

  struct OneRank {
    std::vector<Told> told;
    std::unique_ptr<Coupling> coupling;
    std::optional<RankLoop> loop;
    std::atomic<std::int64_t> triangles = 0;
    std::exception_ptr failure;
  };

  void run_rank(Rank r) {
    try {
      protocol::run_rank(network_.transport(r), [&] { return step(r); });
    } catch (const std::exception&) {
      ranks_[r].failure = std::current_exception();
      failed_ = true;
    }
  }

  // Once a rank has failed, all leave: they have nothing in hand that others wait for.
  protocol::StepResult step(Rank r) {
    if (failed_) return protocol::StepResult::kFinished;
    const protocol::StepResult result = ranks_[r].loop->step();
    if (r == kCalling && all_.watch_.progress) show_progress();
    if (r == kCalling && all_.watch_.stepped) all_.watch_.stepped(triangles(), ranks_[r].loop->next());
    if (result != protocol::StepResult::kFinished && all_.watch_.halts && all_.watch_.halts()) halt(*ranks_[r].loop);
    return result;
  }

  /// Gives up, for now: what is under way arrives, and nobody works anymore.
  static void halt(RankLoop& loop) {
    if (loop.protocol().phase() == protocol::Termination::Phase::kWorking) loop.abandon();
  }

  void show_progress() {
    const std::int64_t triangles = this->triangles();
    if (std::exchange(shown_, triangles) != triangles) all_.watch_.progress(triangles);
  }

  [[nodiscard]] RankLoop::Observers observers(Rank r) {
    RankLoop::Observers observers;
    observers.stalled = all_.watch_.stalled;
    observers.after_slice = [this, &rank = ranks_[r]](const RankLoop& loop, const RankLoop::Slice&) {
      rank.triangles = loop.triangles();
      if (all_.watch_.check) all_.watch_.check(triangles());
    };
    return observers;
  }

  [[nodiscard]] std::int64_t triangles() const {
    std::int64_t sum = 0;
    for (const OneRank& rank : ranks_) sum += rank.triangles;
    return sum;
  }

  RefinementInRounds& all_;
  LoopPlan plan_;
  protocol::ThreadNetwork network_;
  IdVector<Rank, OneRank> ranks_;
  std::atomic<bool> failed_ = false;
  std::int64_t shown_ = -1;  // triangles, as progress
};

void deal_to_threads(RunPlan& plan, std::int32_t threads, const std::function<bool(SubdomainId)>& here) {
  const auto work_in = [&](SubdomainId s) { return here && !here(s) ? 0 : plan.decomposition.subdomains[s].predicted; };
  double all = 0, before = 0;
  for (const SubdomainId s : ids_of(plan.owners)) all += work_in(s);
  for (const SubdomainId s : ids_of(plan.owners)) {
    const double share = before / std::max(all, 1.0) * threads;
    plan.owners[s] = static_cast<Rank>(std::min(threads - 1, static_cast<std::int32_t>(share)));
    before += work_in(s);
  }
  if (threads == 1) plan.policy.reset();
  plan.layout = plan.policy ? layout_of(plan, threads) : nullptr;
}

RefinementInRounds::RefinementInRounds(const RunPlan& plan, std::span<const SizeField* const> sizes, Watch watch,
                                       std::optional<HeldOnRanks> others)
    : plan_(plan), watch_(std::move(watch)), others_(others), outcomes_(sizes.size()) {
  for (const SizeField* size : sizes) {
    SubdomainContext& context = contexts_.emplace_back(context_of(plan));
    context.bounds.size = size;
    if (watch_.finished)
      context.finished = [this, size](const Subdomain& subdomain) { watch_.finished(subdomain, size); };
  }
  for (const SubdomainContext& context : contexts_) held_.push_back(Subdomains(context));
  for (const SubdomainId s : ids_of(plan.owners))
    if (is_here(s)) held_[plan.owners[s]].make(s);
}

RefinementInRounds::~RefinementInRounds() = default;

void RefinementInRounds::run() {
  for (bool all_told = false; !all_told;) {
    refine_for_a_round();
    all_told = !tell_neighbors(take_told());
  }
  for (Subdomains& held : held_) subdomains_.merge(held.take());
}

void RefinementInRounds::refine_for_a_round() {
  ++rounds_;
  for (bool over = false; !over;) {
    if (others_)
      others_->ranks.agree([&] { refine_until_fence(); });
    else
      refine_until_fence();
    over = !watch_.fence || watch_.fence(rests());
  }
}

/// Each point once, in an order that does not depend on who put it there.
std::vector<RefinementInRounds::Told> RefinementInRounds::take_told() {
  std::vector<Told> all;
  for (const auto& one : std::exchange(told_, {})) all.insert(all.end(), one.second.begin(), one.second.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

void RefinementInRounds::refine_until_fence() {
  Round round(*this, present_plan());
  begun_ = true;
  round.run();
  for (const Rank r : ids_of(outcomes_)) add(outcomes_[r], round.outcome(r));
  round.add_told(told_);
}

bool RefinementInRounds::rests() const {
  return std::ranges::none_of(held_, [](const Subdomains& held) {
    return std::ranges::any_of(held.all(), [](const auto& one) { return one.second.active(); });
  });
}

std::vector<SubdomainId> RefinementInRounds::here() const {
  std::vector<SubdomainId> all;
  for (const Subdomains& held : held_)
    for (const auto& one : held.all()) all.push_back(one.first);
  std::ranges::sort(all);
  return all;
}

const Subdomain& RefinementInRounds::at(SubdomainId s) const {
  for (const Subdomains& held : held_)
    if (const auto found = held.all().find(s); found != held.all().end()) return found->second;
  throw Error("subdomain " + to_string(s) + " is not here");
}

std::int64_t RefinementInRounds::triangles() const {
  std::int64_t sum = 0;
  for (const Subdomains& held : held_)
    for (const auto& one : held.all()) sum += one.second.triangles();
  return sum;
}

Bytes RefinementInRounds::halted(SubdomainId s) const {
  ByteWriter writer;
  writer.number(static_cast<std::int32_t>(rounds_));
  writer.array(at(s).pack_small());
  if (const auto found = told_.find(s); found != told_.end())
    for (const Told& t : found->second) {
      writer.value(t.split.root);
      writer.value(t.split.path);
    }
  return writer.take();
}

void RefinementInRounds::take_up(SubdomainId s, std::span<const std::byte> halted) {
  ByteReader reader(halted);
  rounds_ = reader.number<std::int32_t>() - 1;
  Bytes packed;
  reader.array(packed);
  const Rank owner = plan_.owners[s];
  Subdomain subdomain = Subdomain::unpack(packed, contexts_[owner]);
  if (subdomain.id() != s) throw Error("subdomain " + to_string(s) + " is another one");
  held_[owner].put(std::move(subdomain));
  const auto& roots = plan_.decomposition.roots;
  while (!reader.at_end()) {
    SplitPoint<GlobalRootId> split;
    reader.value(split.root);
    reader.value(split.path);
    if (!roots.has(split.root) || !roots[split.root].is_interface())
      throw Error("subdomain " + to_string(s) + " has a point on a border that does not exist");
    told_[s].push_back({roots[split.root].across_from(s), split});
  }
  begun_ = true;
}

/// False if nobody had anything to tell.
bool RefinementInRounds::tell_neighbors(std::vector<Told> told) {
  bool any = !told.empty();
  if (others_ && !others_->ranks.alone()) {
    std::int64_t triangles = 0, all_triangles = 0;
    for (const RankOutcome& outcome : outcomes_) triangles += outcome.triangles;
    ByteWriter own;
    own.value(triangles);
    own.value(static_cast<std::uint8_t>(any ? 1 : 0));
    for (const Bytes& bytes : others_->ranks.bytes_of_all(own.take())) {
      ByteReader reader(bytes);
      all_triangles += reader.value<std::int64_t>();
      any = reader.value<std::uint8_t>() != 0 || any;
    }
    others_->ranks.agree([&] {
      if (watch_.check_all) watch_.check_all(all_triangles);
    });
    if (any) told = swap_with_ranks(told);
  }
  for (const Told& t : told)
    for (Subdomains& held : held_)
      if (Work* const subdomain = held.find(t.to)) subdomain->tell(std::span(&t.split, 1));
  return any;
}

/// What subdomains here are told by those of all ranks, in the same order as if all of them were here.
std::vector<RefinementInRounds::Told> RefinementInRounds::swap_with_ranks(const std::vector<Told>& told) {
  std::map<Rank, ByteWriter> to_others;
  for (const Decomposition::Root& root : plan_.decomposition.roots) {
    if (!root.is_interface() || is_here(root.left) == is_here(root.right)) continue;
    to_others[others_->holders[is_here(root.left) ? root.right : root.left]];
  }
  std::vector<Told> own;
  for (const Told& t : told) {
    if (is_here(t.to)) {
      own.push_back(t);
      continue;
    }
    ByteWriter& writer = to_others.at(others_->holders[t.to]);
    writer.value(t.to);
    writer.value(t.split.root);
    writer.value(t.split.path);
  }
  std::vector<Mail> mail;
  for (auto& [rank, writer] : to_others) mail.push_back({rank, writer.take()});
  for (const Mail& from : others_->ranks.swap(std::move(mail)))
    for (ByteReader reader(from.bytes); !reader.at_end();) {
      Told& t = own.emplace_back();
      reader.value(t.to);
      reader.value(t.split.root);
      reader.value(t.split.path);
    }
  std::sort(own.begin(), own.end());
  return own;
}

/// The plan from where the subdomains are now, with the work that is left.
LoopPlan RefinementInRounds::present_plan() const {
  LoopPlan plan = static_cast<const LoopPlan&>(plan_);
  if (!begun_) return plan;
  auto layout = plan.layout ? std::make_shared<balancer::Layout>(*plan.layout) : nullptr;
  for (const Rank r : ids_of(held_))
    for (const auto& [id, subdomain] : held_[r].all()) {
      plan.owners[id] = r;
      if (!layout) continue;
      layout->subdomains[id].owner = r;
      layout->subdomains[id].predicted = subdomain.remaining();
    }
  plan.layout = std::move(layout);
  return plan;
}

}  // namespace driftmesh
