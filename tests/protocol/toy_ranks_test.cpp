#include <doctest/doctest.h>

#include <array>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>

#include "protocol/toy_rank.hpp"
#include "protocol/virtual_network.hpp"
#include "support/adversarial_network.hpp"
#include "support/broken_rules.hpp"
#include "support/id_literals.hpp"
#include "support/rules_over_tree.hpp"

using namespace driftmesh;
using namespace driftmesh::protocol;
using namespace driftmesh::protocol::toy;

namespace {

// Totals over many runs, so that a test can check that its runs were hard.
struct Tally {
  std::int64_t splits = 0, batches = 0, hand_offs = 0, forwarded = 0, held = 0;
  std::uint64_t reordered = 0, copies = 0, starved = 0, held_back = 0, late_rounds = 0;
};

class Run {
 public:
  Run(std::uint64_t seed, std::int32_t ranks, const Rules& rules, const MeshRules& mesh)
      : world_(seed, ranks), network_(ranks, adversary(seed)), rules_(rules, testing::arity_for(seed)) {
    for (const Rank r : first_ids<Rank>(ranks))
      ranks_.push_back(std::make_unique<ToyRank>(network_.transport(r), world_, rules_, mesh));
  }

  // The first problem, or "".
  std::string verdict(Tally& tally) {
    IdVector<Rank, RankStep> steps;
    for (auto& rank : ranks_) steps.push_back([this, &rank] { return watched(*rank); });
    try {
      const RunResult result = network_.run(steps);
      if (result.end == RunEnd::kStalled) return "stalled";
      if (result.end == RunEnd::kStepLimit) return "does not end";
    } catch (const Wrong& wrong) {
      return wrong.what;
    } catch (const Error& error) {
      return std::string("error: ") + error.what();
    }
    add_to(tally);
    return verdict_on_the_end();
  }

 private:
  struct Wrong {
    std::string what;
  };

  static Adversary adversary(std::uint64_t seed) {
    Adversary result = Adversary::from_seed(seed);
    result.may_copy = [](Rank source, auto bytes) { return traffic_of(source, bytes) == Traffic::kDetection; };
    result.step_limit = 400'000;
    return result;
  }

  StepResult watched(ToyRank& rank) {
    const StepResult result = rank.step();
    if (rank.broken()) throw Wrong{"a point without its parent"};
    const bool quiet = !work_anywhere();
    if (!quiet && rank.protocol().phase() != Termination::Phase::kWorking) throw Wrong{"terminated too early"};
    const std::uint64_t rounds = ranks_[0_rank]->protocol().termination().rounds();
    if (quiet && !rounds_when_quiet_) rounds_when_quiet_ = rounds;
    if (quiet && rounds > *rounds_when_quiet_ + 2) throw Wrong{"terminated too late"};
    if (!quiet && rounds_when_quiet_) throw Wrong{"work out of nothing"};
    return result;
  }

  // The actual state, from the ranks' subdomains and the messages on the network, not from the ranks' own counts.
  bool work_anywhere() {
    for (const auto& rank : ranks_)
      if (rank->at_work()) return true;
    for (const Rank r : first_ids<Rank>(world_.ranks))
      for (const auto& parcel : network_.under_way(r))
        if (traffic_of(parcel.source, parcel.bytes) == Traffic::kWork) return true;
    return false;
  }

  std::string verdict_on_the_end() {
    if (network_.in_flight() != 0) return "messages left behind";
    std::map<SubdomainId, const Subdomain*> all;
    for (const auto& rank : ranks_)
      for (const auto& [id, subdomain] : rank->subdomains())
        if (!all.emplace(id, &subdomain).second) return "a subdomain with two owners";
    if (all.size() != world_.owners.size()) return "a subdomain is lost";
    for (const GlobalRootId e : ids_of(world_.edges)) {
      auto one = all.at(world_.edges[e].one)->points().at(e);
      auto other = all.at(world_.edges[e].other)->points().at(e);
      std::sort(one.begin(), one.end());
      std::sort(other.begin(), other.end());
      if (one != other) return "the two sides of an edge differ";
    }
    return {};
  }

  void add_to(Tally& tally) {
    for (const auto& rank : ranks_) {
      const ProtocolCounters& counters = rank->protocol().counters();
      tally.splits += counters.splits_sent;
      tally.batches += counters.batches_sent;
      tally.hand_offs += counters.hand_offs;
      tally.forwarded += counters.forwarded;
      tally.held += counters.held;
    }
    tally.reordered += network_.counters().reordered;
    tally.copies += network_.counters().copies;
    tally.starved += network_.counters().starved;
    tally.held_back += network_.counters().held;
    tally.late_rounds = std::max(tally.late_rounds, ranks_[0_rank]->protocol().termination().rounds() -
                                                        rounds_when_quiet_.value_or(UINT64_MAX / 2));
  }

  World world_;
  AdversarialNetwork network_;
  testing::RulesOverTree rules_;
  IdVector<Rank, std::unique_ptr<ToyRank>> ranks_;
  std::optional<std::uint64_t> rounds_when_quiet_;
};

std::int32_t ranks_for(std::uint64_t seed) {
  static constexpr std::array<std::int32_t, 8> kRanks{2, 3, 4, 1, 5, 2, 8, 16};
  return kRanks[seed % kRanks.size()];
}

std::string verdict(std::uint64_t seed, Tally& tally, const Rules& rules = sound_rules(), const MeshRules& mesh = {}) {
  return Run(seed, ranks_for(seed), rules, mesh).verdict(tally);
}

// A broken rule must be found within this number of seeds, and for the right reason.
void must_be_caught(const Rules& rules, std::uint64_t seeds, std::string_view as, const MeshRules& mesh = {}) {
  Tally tally;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const std::string what = verdict(seed, tally, rules, mesh);
    if (what.empty()) continue;
    MESSAGE("caught at seed ", seed, ": ", what);
    CHECK(what.find(as) != std::string::npos);
    return;
  }
  FAIL("not caught within ", seeds, " seeds");
}

// DRIFTMESH_SEEDS=N runs N seeds instead.
std::uint64_t seeds_to_run(std::uint64_t usual) {
  const char* wish = std::getenv("DRIFTMESH_SEEDS");
  return wish == nullptr ? usual : std::strtoull(wish, nullptr, 10);
}

}  // namespace

TEST_CASE("random work on an adversarial network: nothing is lost, and termination is detected in time") {
  Tally tally;
  for (std::uint64_t seed = 1, last = seeds_to_run(2000); seed <= last; ++seed) {
    CAPTURE(seed);
    REQUIRE(verdict(seed, tally) == "");
  }
  MESSAGE(tally.splits, " splits in ", tally.batches, " batches, ", tally.hand_offs, " hand-offs, ", tally.forwarded,
          " groups forwarded, ", tally.held, " held; ", tally.reordered, " messages reordered, ", tally.copies,
          " copied; at most ", tally.late_rounds, " probes after the last work");
  CHECK(tally.splits > tally.batches + 1000);
  CHECK(tally.hand_offs > 1000);
  CHECK(tally.forwarded > 1000);
  CHECK(tally.held > 500);
  CHECK(tally.reordered > 1000);
  CHECK(tally.copies > 1000);
  CHECK(tally.starved > 1000);
  CHECK(tally.held_back > 1000);
  CHECK(tally.late_rounds == 2);
}

TEST_CASE("mutation: an aggregator that is not flushed counts as passive") {
  must_be_caught(testing::PassiveWithSplitsToSend(), 50, "terminated too early");
}

TEST_CASE("mutation: an idle rank does not flush its aggregator") {
  must_be_caught(testing::NoFlushWhenIdle(), 50, "stalled");
}

TEST_CASE("mutation: the token is passed by a rank that is active") {
  struct AlwaysPassive final : Rules {
    [[nodiscard]] bool passive(bool, bool, bool) const override { return true; }
  };
  must_be_caught(AlwaysPassive(), 200, "sends work although it was passive");
}

TEST_CASE("mutation: forwarding counts as sending") {
  must_be_caught(testing::ForwardingCountsAsSending(), 200, "sends work although it was passive");
}

TEST_CASE("mutation: held messages count as handled twice") {
  must_be_caught(testing::HoldingCountsAsHandling(), 50, "terminated too late");
}

TEST_CASE("mutation: hand-offs are not counted") {
  must_be_caught(testing::HandOffsAreNotCounted(), 50, "");
}

TEST_CASE("mutation: location records without epochs") {
  must_be_caught(testing::NoEpochs(), 500, "");
}

TEST_CASE("mutation: missing ancestors are not replayed") {
  must_be_caught(sound_rules(), 50, "a point without its parent", {.replays_ancestors = false});
}

TEST_CASE("mutation: an existing point is inserted again") {
  must_be_caught(sound_rules(), 50, "the two sides of an edge differ", {.inserts_again = true});
}

TEST_CASE("the same ranks in virtual time") {
  for (const std::size_t count : {1u, 4u, 64u}) {
    const World world(9, static_cast<std::int32_t>(count));
    VirtualCluster cluster{.speeds = IdVector<Rank, double>(count, 1.0), .link = {}};
    VirtualNetwork network(cluster);
    std::vector<std::unique_ptr<ToyRank>> ranks;
    IdVector<Rank, RankStep> steps;
    for (const Rank r : first_ids<Rank>(count)) {
      ranks.push_back(std::make_unique<ToyRank>(network.transport(r), world));
      steps.push_back([&network, r, rank = ranks.back().get()] {
        const StepResult result = rank->step();
        if (result == StepResult::kBusy) network.transport(r).spend(1e-5);
        return result;
      });
    }
    CHECK(network.run(steps).end == RunEnd::kFinished);
    for (const auto& rank : ranks) CHECK(!rank->at_work());
  }
}
