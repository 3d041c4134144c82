#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "balancer/snapshot/codec.hpp"
#include "driftmesh/policy.hpp"
#include "protocol/codec.hpp"
#include "runtime/rank_loop.hpp"
#include "support/id_literals.hpp"
#include "support/simulated_crew.hpp"

// The loop of one rank. The test plays the others: it writes what they send, and reads what they get.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

/// A number of triangles at a time, with a second for each slice.
class Traveler final : public Work {
 public:
  /// What a rank knows of it, and takes along.
  struct Progress {
    std::int32_t slices = 1;  ///< left
    std::int32_t each = 100;  ///< triangles of a slice
    std::int64_t triangles = 0;
    double forecast = 100;
  };
  Traveler(SubdomainId id, const Progress& so_far) : Work(id), progress(so_far) {}

  [[nodiscard]] WorkState state() const override {
    return {.active = progress.slices > 0,
            .started = progress.triangles > 0,
            .refined = progress.slices == 0,
            .backlog = 0,
            .triangles = progress.triangles,
            .predicted = progress.forecast,
            .forecast = progress.forecast,
            .remaining = std::max(1.0, progress.forecast - static_cast<double>(progress.triangles)),
            .packed_bytes = 40};
  }
  void tell(std::span<const SplitPoint<GlobalRootId>> splits) override { told += splits.size(); }
  SliceWork work(std::int64_t, std::vector<SplitPoint<GlobalRootId>>&) override {
    const bool begun = progress.triangles == 0;
    --progress.slices;
    progress.triangles += progress.each;
    return {.triangles = progress.each, .begun = begun, .seconds = 1};
  }
  [[nodiscard]] Bytes pack() const override {
    ByteWriter writer;
    writer.value(id());
    writer.value(progress);
    return writer.take();
  }

  Progress progress;
  std::size_t told = 0;
};

class Travelers final : public HoldingOf<Traveler> {
 public:
  Work& unpack(std::span<const std::byte> packed) override {
    ByteReader reader(packed);
    const auto id = reader.value<SubdomainId>();
    return put(Traveler(id, reader.value<Traveler::Progress>()));
  }
};

/// A single border, of which nobody is told.
class SilentBorder final : public Coupling {
 public:
  [[nodiscard]] std::optional<SubdomainId> to_tell(SubdomainId, const SplitPoint<GlobalRootId>&) override { return {}; }
  [[nodiscard]] std::int32_t roots() const override { return 1; }
};

/// The letters of one rank. Its clock shows what it has spent.
class Letters final : public protocol::Transport {
 public:
  Letters(Rank self, std::int32_t ranks, std::int32_t subdomains) : self_(self), limits_{ranks, subdomains, 1} {}
  [[nodiscard]] Rank rank() const override { return self_; }
  [[nodiscard]] std::int32_t ranks() const override { return limits_.ranks; }
  void send(Rank destination, Bytes bytes) override { sent_.push_back({destination, std::move(bytes)}); }
  std::optional<protocol::Received> poll() override {
    if (come_.empty()) return {};
    protocol::Received first = std::move(come_.front());
    come_.erase(come_.begin());
    return first;
  }
  void idle() override {}
  [[nodiscard]] double now() const override { return clock_; }
  void spend(double seconds) override { clock_ += seconds; }

  void come(Rank from, const protocol::Message& message) { come_.push_back({from, protocol::encode(message)}); }
  void advise(Rank from, const balancer::Message& message) { come(from, balancer::encode(message)); }
  /// What was sent of one kind since the last call of this or advised().
  template <class M>
  [[nodiscard]] std::vector<M> sent() {
    std::vector<M> found;
    for (const auto& [to, bytes] : std::exchange(sent_, {})) {
      const protocol::Message message = protocol::decode(self_, bytes, limits_);
      if (const auto* const one = std::get_if<M>(&message)) found.push_back(*one);
    }
    return found;
  }
  template <class M>
  [[nodiscard]] std::vector<M> advised() {
    std::vector<M> found;
    for (const protocol::Advice& advice : sent<protocol::Advice>()) {
      const balancer::Message message = balancer::decode(self_, advice, limits_);
      if (const auto* const one = std::get_if<M>(&message)) found.push_back(*one);
    }
    return found;
  }

 private:
  Rank self_;
  protocol::WireLimits limits_;
  double clock_ = 0;
  std::vector<protocol::Received> come_;
  std::vector<std::pair<Rank, Bytes>> sent_;
};

/// One of two ranks, and all that its loop needs. With a leader that shows what it knows, and moves nothing.
struct PlayedRank {
  PlayedRank(Rank self, std::size_t subdomains, Rank holder) : letters(self, 2, static_cast<std::int32_t>(subdomains)) {
    plan.owners = IdVector<SubdomainId, Rank>(subdomains, holder);
    balancer::Layout layout;
    layout.ranks = 2;
    layout.subdomains.resize(subdomains);
    for (balancer::Layout::Subdomain& s : layout.subdomains) s.owner = holder;
    plan.layout = std::make_shared<const balancer::Layout>(layout);
    plan.policy = balancer::leader_policy([this](const balancer::LoadSnapshot& load) {
      shown.push_back(load);
      return std::vector<balancer::Move>{};
    });
    plan.balancing.options.gap = plan.balancing.options.look = 0;
    plan.balancing.options.worth.gain = 0;
  }
  void begin(RankLoop::Observers observers = {}) {
    loop.emplace(letters, plan, travelers, border, CostModel{}, std::move(observers));
  }
  void step() { static_cast<void>(loop->step()); }

  LoopPlan plan;
  Letters letters;
  Travelers travelers;
  SilentBorder border;
  std::vector<balancer::LoadSnapshot> shown;
  std::optional<RankLoop> loop;
};

/// A thread that begins what it is given, and ends it once somebody waits for it.
class BusyCrew final : public Crew {
 public:
  [[nodiscard]] std::size_t size() const override { return 1; }
  void start(Shift& shift) override { started_.push_back(&shift); }
  [[nodiscard]] Shift* finished() override {
    if (!awaited_ || started_.empty()) return nullptr;
    Shift* const shift = started_.back();
    started_.pop_back();
    shift->perform();
    return shift;
  }
  void wait() override { awaited_ = true; }

 private:
  std::vector<Shift*> started_;
  bool awaited_ = false;
};

}  // namespace

TEST_CASE("points that have come before their subdomain are work, and a rank that waits for it says so soon") {
  PlayedRank rank(1_rank, 1, 0_rank);
  rank.plan.policy = nullptr;
  int alarms = 0;
  RankLoop::Observers observers;
  observers.stalled = [&](const std::string&) { ++alarms; };
  rank.begin(observers);
  rank.step();
  CHECK_FALSE(rank.loop->at_work());
  rank.letters.spend(100);
  rank.step();
  CHECK(alarms == 0);  // it may well take long until there is work

  rank.letters.come(0_rank, protocol::SplitBatch{{{0_sub, 1, 0_rank, 0, {{GlobalRootId{0}, 1}}}}});
  rank.step();
  CHECK(rank.loop->protocol().held_groups() == 1);
  CHECK(rank.loop->at_work());
  rank.letters.spend(100);
  rank.step();
  CHECK(alarms == 1);

  rank.letters.come(0_rank, protocol::HandOff{0_sub, 1, Traveler(0_sub, {.slices = 2}).pack()});
  rank.step();
  CHECK(rank.travelers.all().at(0_sub).told == 1);
  rank.step();
  CHECK_FALSE(rank.loop->at_work());
}

TEST_CASE("a rank reports what was finished as soon as it came with the epoch in which it came") {
  PlayedRank rank(1_rank, 2, 0_rank);
  rank.begin();
  rank.letters.come(0_rank, protocol::HandOff{1_sub, 3, Traveler(1_sub, {}).pack()});
  rank.step();
  const auto reports = rank.letters.advised<balancer::LoadReport>();
  REQUIRE(reports.size() == 1);
  CHECK(reports[0].loads == std::vector<balancer::ReportedLoad>{{1_sub, 3, 0, 0}});
}

TEST_CASE("what a rank does last it does itself, not its crew") {
  const auto done_by_crew = [](std::int32_t subdomains) {
    Letters letters(0_rank, 1, subdomains);
    LoopPlan plan;
    plan.owners = IdVector<SubdomainId, Rank>(to_index(subdomains), 0_rank);
    Travelers travelers;
    for (const SubdomainId id : ids_of(plan.owners)) travelers.put(Traveler(id, {.slices = 5}));
    SilentBorder border;
    SimulatedCrew crew(2, 1);
    RankLoop loop(letters, plan, travelers, border);
    loop.hire(crew);
    while (loop.step() != protocol::StepResult::kFinished) {
    }
    CHECK(loop.triangles() == 500 * subdomains);
    return crew.performed();
  };
  CHECK(done_by_crew(1) == 0);
  CHECK(done_by_crew(6) > 0);
}

TEST_CASE("nothing is balanced any more when all work is over") {
  PlayedRank rank(1_rank, 1, 0_rank);
  int looks = 0;
  RankLoop::Observers observers;
  observers.deliberated = [&](const std::vector<balancer::Deliberation>&) { ++looks; };
  rank.begin(observers);
  rank.step();
  rank.step();
  CHECK(looks == 2);
  rank.letters.come(0_rank, protocol::Terminate{.round = 1});
  rank.step();
  rank.step();
  CHECK(looks == 2);
}

TEST_CASE("a rank says that a subdomain does not come after all, which its crew was working on") {
  BusyCrew crew;
  PlayedRank rank(1_rank, 3, 1_rank);
  for (const SubdomainId id : ids_of(rank.plan.owners))
    rank.travelers.put(Traveler(id, {.slices = 100, .forecast = 10'000}));
  rank.begin();
  rank.loop->hire(crew);
  rank.step();  // the crew begins two of them
  rank.letters.advise(0_rank, balancer::Plan{1, {{0_sub, 0_rank}}, {0_rank}});
  rank.step();
  const auto asked = rank.letters.advised<balancer::Admission>();
  REQUIRE(asked.size() == 1);
  CHECK(asked[0].stage == balancer::Admission::Stage::kAsk);
  rank.letters.advise(0_rank,
                      balancer::Admission{asked[0].round, balancer::Admission::Stage::kAnswer, asked[0].guests});
  rank.step();
  rank.step();
  CHECK(rank.loop->protocol().holds(0_sub));
  const auto told = rank.letters.advised<balancer::Admission>();
  REQUIRE(told.size() == 1);
  CHECK(told[0] == balancer::Admission{asked[0].round, balancer::Admission::Stage::kReturn, asked[0].guests});
}

TEST_CASE("a rank learns nothing from a subdomain that was refined elsewhere meanwhile") {
  // Subdomain 0 makes five times as many triangles as forecast. What is then expected of one that nobody has begun?
  const auto expected = [](bool travels) {
    PlayedRank rank(0_rank, 3, 0_rank);
    rank.travelers.put(Traveler(0_sub, {.slices = 5, .each = 1000, .forecast = 1000}));
    for (const SubdomainId id : {1_sub, 2_sub})
      rank.travelers.put(Traveler(id, {.slices = 5, .each = 200, .forecast = 1000}));
    rank.begin();
    std::uint32_t reports = 0;
    const auto hear_and_step = [&] {
      rank.letters.advise(1_rank, balancer::LoadReport{++reports, 0, 1000, {}});
      rank.step();
    };
    hear_and_step();
    if (travels) {
      REQUIRE(rank.loop->hand_over(0_sub, 1_rank));
      rank.step();
      auto gone = rank.letters.sent<protocol::HandOff>();
      REQUIRE(gone.size() == 1);
      gone[0].epoch = 2;
      rank.letters.come(1_rank, gone[0]);
    }
    do hear_and_step();
    while (rank.travelers.all().at(0_sub).progress.slices > 0);
    rank.shown.clear();
    hear_and_step();
    REQUIRE(!rank.shown.empty());
    REQUIRE(rank.travelers.all().at(2_sub).progress.triangles == 0);
    return find(rank.shown.back(), 2_sub)->remaining;
  };
  const double as_forecast = balancer::kWorkToStart + 1000;
  CHECK(expected(true) == doctest::Approx(as_forecast));
  CHECK(expected(false) > 2 * as_forecast);
}
