#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <string>
#include <string_view>

#include "property/cases.hpp"
#include "protocol/counter_sum.hpp"
#include "sim/adversarial_run.hpp"
#include "sim/tampering.hpp"
#include "support/broken_rules.hpp"

using namespace driftmesh;
using namespace driftmesh::sim;

namespace {

// A broken rule must be found within this number of seeds by the oracle responsible for it, whatever other oracles
// find in other seeds.
void must_be_caught(const protocol::Rules& rules, std::uint64_t seeds, std::string_view as,
                    const AdversarialRun::Wrap& wrap = {}) {
  Domains domains;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const Scenario scenario = Scenario::from_seed(seed);
    const std::string failure = AdversarialRun(scenario, domains[scenario.domain], wrap, rules).run().failure();
    if (failure.empty() || failure.find(as) == std::string::npos) continue;
    MESSAGE("caught at seed ", seed, ": ", failure);
    return;
  }
  FAIL("not caught within ", seeds, " seeds");
}

using Layer = std::unique_ptr<protocol::Transport>;
using FindLoop = std::function<const SubdomainLoop&()>;

// Edges and subdomains with any number: the loop checks them again.
protocol::WireLimits limits_of(const protocol::Transport& transport) {
  return {transport.ranks(), 1 << 20, 1 << 20};
}

AdversarialRun::Wrap tampering(Tampering tamper) {
  return [tamper](protocol::Transport& transport, FindLoop loop) {
    return std::make_unique<TamperingTransport>(transport, tamper, limits_of(transport),
                                                [loop = std::move(loop)](SubdomainId s) -> const Subdomain* {
                                                  const auto place = loop().subdomains().find(s);
                                                  return place == loop().subdomains().end() ? nullptr : &place->second;
                                                });
  };
}

}  // namespace

TEST_CASE("the schedules are hard, on every domain and number of ranks") {
  Domains domains;
  protocol::ProtocolCounters sum;
  AdversaryEffects effects;
  protocol::AdversarialNetwork::Counters network;
  std::set<std::string> compared, shapes, movers;
  std::set<std::int32_t> ranks;
  std::uint64_t late_rounds = 0;
  std::int64_t smallest = INT64_MAX, asleep = 0, shifts = 0;
  const auto seeds =
      static_cast<std::uint64_t>(testing::case_count(3000));  // a tenth of that must still contain the rare events
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    CAPTURE(seed);
    const Scenario scenario = Scenario::from_seed(seed);
    const Outcome o = AdversarialRun(scenario, domains[scenario.domain]).run();
    REQUIRE(o.failure() == "");
    shapes.insert(scenario.domain);
    ranks.insert(scenario.ranks);
    if (o.counters.hand_offs > 0) movers.insert(scenario.mover);
    if (o.digest_compared) compared.insert(scenario.domain);
    smallest = std::min(smallest, o.triangles);
    asleep += o.asleep;
    shifts += o.shifts;
    sum += o.counters;
    network.reordered += o.network.reordered;
    network.copies += o.network.copies;
    network.starved += o.network.starved;
    network.held += o.network.held;
    effects += o.effects;
    late_rounds = std::max(late_rounds, o.late_rounds);
  }
  MESSAGE(sum.splits_sent, " SPLITs in ", sum.batches_sent, " messages, ", sum.hand_offs, " moves, ", sum.forwarded,
          " groups forwarded, ", sum.held, " held; at most ", late_rounds, " probes after the last work");
  MESSAGE(words_of(effects));
  const auto at_least = static_cast<std::int64_t>(seeds / 10);
  CHECK(shapes.size() == domain_names().size());
  CHECK(movers.size() == mover_names().size());
  CHECK(effects.by_chance > at_least);
  CHECK(effects.returns > at_least);
  CHECK(effects.rotations > at_least);
  CHECK(effects.behind_token > at_least / 2);
  CHECK(effects.by_policy > at_least);
  CHECK(effects.hand_offs_ahead > at_least);
  CHECK(effects.splits_ahead > at_least);
  CHECK(effects.late_locations > at_least);
  CHECK(effects.repeated_locations > at_least);
  CHECK(effects.outdated_locations > at_least);
  CHECK(effects.late_plans > at_least / 20);
  CHECK(effects.questions > at_least / 20);
  CHECK(effects.starved > at_least);
  CHECK(effects.most_hops > 1);
  CHECK(ranks.contains(1));
  CHECK(ranks.contains(16));
  CHECK(compared.contains("square"));
  CHECK(compared.contains("ell"));
  CHECK(smallest > 30);
  CHECK(asleep > at_least);
  CHECK(shifts > 10 * at_least);
  CHECK(sum.splits_sent > 20 * at_least);
  CHECK(sum.splits_sent > sum.batches_sent);
  CHECK(sum.hand_offs > 10 * at_least);
  CHECK(sum.forwarded > 10 * at_least);
  CHECK(sum.held > at_least);
  CHECK(network.reordered > seeds);
  CHECK(network.copies > seeds / 10);
  CHECK(network.starved > seeds);
  CHECK(network.held > seeds / 10);
  CHECK(late_rounds == 2);
}

TEST_CASE("a run is repeated exactly by its seed") {
  Domains domains;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Scenario scenario = Scenario::from_seed(seed);
    const Outcome one = AdversarialRun(scenario, domains[scenario.domain]).run();
    const Outcome two = AdversarialRun(scenario, domains[scenario.domain]).run();
    CHECK(one.digest == two.digest);
    CHECK(one.steps == two.steps);
    CHECK(one.network.delivered == two.network.delivered);
  }
}

TEST_CASE("mutation: an aggregator that is not flushed counts as passive") {
  must_be_caught(testing::PassiveWithSplitsToSend(), 50, "termination in time: too early");
}

TEST_CASE("mutation: an idle rank does not flush its aggregator") {
  must_be_caught(testing::NoFlushWhenIdle(), 50, "stalled");
}

TEST_CASE("mutation: the token is passed by a rank that is active") {
  struct AlwaysRests final : protocol::Rules {
    [[nodiscard]] bool rests(bool) const override { return true; }
  };
  must_be_caught(AlwaysRests(), 50, "sends work although it was passive");
}

TEST_CASE("mutation: forwarding counts as sending") {
  must_be_caught(testing::ForwardingCountsAsSending(), 100, "");
}

TEST_CASE("mutation: held messages count as handled twice") {
  must_be_caught(testing::HoldingCountsAsHandling(), 100, "termination in time: too late");
}

TEST_CASE("mutation: held messages count as handled and are never delivered") {
  struct HeldIsHandled final : protocol::Rules {
    [[nodiscard]] bool counts_as_handled(Station station) const override {
      return station == Station::kHeld || (station != Station::kReleased && Rules::counts_as_handled(station));
    }
    [[nodiscard]] bool passive(bool program_is_passive, bool aggregator_empty, bool) const override {
      return program_is_passive && aggregator_empty;
    }
  };
  must_be_caught(HeldIsHandled(), 100, "tokens have the right count and color");
}

TEST_CASE("mutation: hand-offs are not counted") {
  must_be_caught(testing::HandOffsAreNotCounted(), 100, "");
}

TEST_CASE("mutation: location records without epochs") {
  must_be_caught(testing::NoEpochs(), 200, "");
}

TEST_CASE("mutation: missing ancestors are not replayed") {
  must_be_caught(protocol::sound_rules(), 400, "both sides of each edge", tampering(drop_orphans));
}

TEST_CASE("mutation: an existing point is inserted again") {
  must_be_caught(protocol::sound_rules(), 50, "both sides of each edge", tampering(insert_again));
}

TEST_CASE("mutation: a message is lost") {
  must_be_caught(
      protocol::sound_rules(), 50, "termination in time: too late",
      [](protocol::Transport& transport, const FindLoop&) { return std::make_unique<LosingTransport>(transport); });
}

TEST_CASE("mutation: a subdomain that returns to a rank is dropped") {
  must_be_caught(protocol::sound_rules(), 50, "termination in time: too late",
                 [](protocol::Transport& transport, const FindLoop&) {
                   return std::make_unique<UnwelcomingTransport>(transport, limits_of(transport));
                 });
}

TEST_CASE("mutation: the packed form omits pending points") {
  must_be_caught(protocol::sound_rules(), 50, "both sides of each edge",
                 [](protocol::Transport& transport, const FindLoop&) {
                   return std::make_unique<ForgetfulTransport>(transport, limits_of(transport));
                 });
}

TEST_CASE("mutation: forwarding changes the color of a rank") {
  for (const bool black : {true, false}) {
    CAPTURE(black);
    must_be_caught(protocol::sound_rules(), 50, "tokens have the right count and color",
                   [black](protocol::Transport& transport, FindLoop loop) {
                     return std::make_unique<RecoloringTransport>(
                         transport, black, [loop] { return loop().protocol().counters().forwarded; });
                   });
  }
}
