#include "runtime/threads/refinement_in_rounds.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <tuple>
#include <utility>

#include "protocol/threads/thread_network.hpp"
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

/// One round, with a loop for each thread.
class RefinementInRounds::Round {
 public:
  /// A point that a subdomain has put on its border, for the subdomain on the other side.
  struct Told {
    SubdomainId to{};
    SplitPoint<GlobalRootId> split;
    [[nodiscard]] auto key() const { return std::tuple(to, split.root, split.path); }
  };

  Round(RefinementInRounds& all, const std::shared_ptr<const balancer::Layout>& layout)
      : all_(all), network_(static_cast<std::int32_t>(all.contexts_.size())), ranks_(all.contexts_.size()) {
    IdVector<Rank, RankLoop::Round> starts(ranks_.size());
    for (auto& [id, subdomain] : all.subdomains_) starts[all.owners_[id]].subdomains.emplace(id, std::move(subdomain));
    all.subdomains_.clear();
    for (const Rank r : ids_of(ranks_)) {
      starts[r].context = &all.contexts_[r];
      starts[r].owners = all.owners_;
      starts[r].layout = layout;
      ranks_[r].loop.emplace(network_.transport(r), std::move(starts[r]), all.plan_, observers(r));
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

  /// What is told across borders, each once, in an order that does not depend on who said it.
  [[nodiscard]] std::vector<Told> told() const {
    std::vector<Told> all;
    for (const OneRank& rank : ranks_) all.insert(all.end(), rank.told.begin(), rank.told.end());
    std::sort(all.begin(), all.end(), [](const Told& a, const Told& b) { return a.key() < b.key(); });
    const auto same = [](const Told& a, const Told& b) { return a.key() == b.key(); };
    all.erase(std::unique(all.begin(), all.end(), same), all.end());
    return all;
  }

  /// Gives the subdomains and the results of the ranks back.
  void end() {
    for (const Rank r : ids_of(ranks_)) {
      add(all_.outcomes_[r], ranks_[r].loop->outcome());
      for (auto& [id, subdomain] : ranks_[r].loop->take_subdomains()) {
        all_.owners_[id] = r;
        all_.subdomains_.emplace(id, std::move(subdomain));
      }
    }
  }

 private:
  static constexpr Rank kCalling{0};  // the rank of the calling thread

  struct OneRank {
    std::optional<RankLoop> loop;
    std::vector<Told> told;
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
    return result;
  }

  void show_progress() {
    const std::int64_t triangles = this->triangles();
    if (std::exchange(shown_, triangles) != triangles) all_.watch_.progress(triangles);
  }

  [[nodiscard]] RankLoop::Observers observers(Rank r) {
    RankLoop::Observers observers;
    observers.stalled = all_.watch_.stalled;
    observers.after_slice = [this, &rank = ranks_[r]](const RankLoop& loop, const RankLoop::Slice& slice) {
      for (const SplitPoint<GlobalRootId>& split : slice.said)
        rank.told.push_back({all_.plan_.decomposition.roots[split.root].across_from(slice.subdomain), split});
      rank.triangles = loop.triangles();
      if (all_.watch_.check) all_.watch_.check(triangles());
    };
    if (all_.watch_.finished)
      observers.finished = [this, size = all_.contexts_[r].bounds.size](const Subdomain& subdomain) {
        all_.watch_.finished(subdomain, size);
      };
    return observers;
  }

  [[nodiscard]] std::int64_t triangles() const {
    std::int64_t sum = 0;
    for (const OneRank& rank : ranks_) sum += rank.triangles;
    return sum;
  }

  RefinementInRounds& all_;
  protocol::ThreadNetwork network_;
  IdVector<Rank, OneRank> ranks_;
  std::atomic<bool> failed_ = false;
  std::int64_t shown_ = -1;  // triangles, as progress
};

RefinementInRounds::RefinementInRounds(const RunPlan& plan, std::span<const SizeField* const> sizes, Watch watch)
    : plan_(plan), watch_(std::move(watch)), owners_(plan.owners), outcomes_(sizes.size()) {
  for (const SizeField* size : sizes) {
    contexts_.push_back({&plan.decomposition, plan.bounds, plan.presplit, plan.scratch});
    contexts_.back().bounds.size = size;
  }
  for (const SubdomainId s : ids_of(owners_)) subdomains_.emplace(s, Subdomain(s, contexts_[owners_[s]]));
}

RefinementInRounds::~RefinementInRounds() = default;

void RefinementInRounds::run() {
  for (bool all_told = false; !all_told;) {
    Round round(*this, rounds_ == 0 ? plan_.layout : present_layout());
    ++rounds_;
    round.run();
    round.end();
    all_told = !tell_neighbors(round);
  }
}

/// False if there was nothing to tell.
bool RefinementInRounds::tell_neighbors(Round& round) {
  const std::vector<Round::Told> told = round.told();
  for (const Round::Told& t : told) subdomains_.at(t.to).tell(t.split);
  return !told.empty();
}

/// Where the subdomains are, and the work that is left.
std::shared_ptr<const balancer::Layout> RefinementInRounds::present_layout() const {
  if (!plan_.layout) return nullptr;
  auto layout = std::make_shared<balancer::Layout>(*plan_.layout);
  for (const auto& [id, subdomain] : subdomains_) {
    layout->subdomains[id].owner = owners_[id];
    layout->subdomains[id].predicted = subdomain.remaining();
  }
  return layout;
}

}  // namespace driftmesh
