#include "protocol/rank_protocol.hpp"

#include <doctest/doctest.h>

using namespace driftmesh;
using namespace driftmesh::protocol;
using Phase = Termination::Phase;

namespace {

// Three ranks; subdomain s starts on rank s. Messages are carried by hand.
struct Ranks {
  std::vector<RankProtocol> all;
  Ranks() {
    for (Rank r = 0; r < 3; ++r) all.emplace_back(r, 3, std::vector<Rank>{0, 1, 2}, 4);
  }
  RankProtocol& operator[](Rank r) { return all[static_cast<std::size_t>(r)]; }

  Delivery carry(Rank from, const Outgoing& outgoing) {
    return (*this)[outgoing.destination].receive(from, outgoing.message);
  }
  // The only message that a rank wants to send.
  Outgoing only(Rank from) {
    auto outgoing = (*this)[from].take_outgoing();
    REQUIRE(outgoing.size() == 1);
    return outgoing[0];
  }
};

}  // namespace

TEST_CASE("SPLITs go out when a batch is full, or when the rank rests") {
  Ranks ranks;
  for (EdgeId edge = 0; edge < 4; ++edge) ranks[0].send_split(1, {edge, 1});
  ranks[0].send_split(1, {9, 3});
  auto delivery = ranks.carry(0, ranks.only(0));
  REQUIRE(delivery.splits.size() == 1);
  CHECK(delivery.splits[0].entries.size() == 4);
  CHECK(ranks[0].aggregated() == 1);
  CHECK(ranks[0].termination().work_balance() == 5);
  CHECK(ranks[1].termination().work_balance() == -4);
  ranks[0].rest(false);
  delivery = ranks.carry(0, ranks.only(0));
  CHECK(delivery.splits[0].entries == std::vector<SplitEntry>{{9, 3}});
  CHECK(ranks[0].counters().batches_sent == 2);
  CHECK_THROWS_AS(ranks[0].send_split(0, {1, 1}), Error);
}

TEST_CASE("a SPLIT follows its subdomain, the sender learns, and counts come out even") {
  Ranks ranks;
  ranks[0].send_split(1, {5, 1});
  ranks[0].rest(false);
  const Outgoing split = ranks.only(0);
  ranks[1].hand_off(1, 2, Bytes(3));
  const Outgoing hand_off = ranks.only(1);
  CHECK(!ranks[1].holds(1));

  // It arrives where the subdomain was: forwarded, and rank 0 is told.
  CHECK(ranks.carry(0, split).splits.empty());
  const auto sent = ranks[1].take_outgoing();
  REQUIRE(sent.size() == 2);
  CHECK(sent[0].destination == 0);
  CHECK(sent[0].message == Message(LocationUpdate{1, 2, 1}));
  ranks.carry(1, sent[0]);
  CHECK(ranks[0].where(1) == Location{2, 1});
  CHECK(ranks[1].termination().work_balance() == 1);  // the hand-off, not what it forwarded

  // It overtakes the hand-off: held, and delivered with it.
  CHECK(ranks.carry(1, sent[1]).splits.empty());
  CHECK(ranks[2].held_groups() == 1);
  CHECK(ranks[2].describe() ==
        "rank 2: working, probe 0 without the token, SPLITs and hand-offs sent less handled 0, 0 SPLITs in the "
        "aggregator, 1 groups held for subdomain 1");
  const Delivery delivery = ranks.carry(1, hand_off);
  REQUIRE(delivery.arrival);
  CHECK(delivery.arrival->packed.size() == 3);
  REQUIRE(delivery.splits.size() == 1);
  CHECK(delivery.splits[0].origin == 0);
  CHECK(delivery.splits[0].hops == 1);
  CHECK(ranks[2].counters().most_hops == 1);
  CHECK(ranks[1].counters().forwarded == 1);
  CHECK(ranks[2].holds(1));
  CHECK(ranks[2].held_groups() == 0);
  std::int64_t sum = 0;
  for (const auto& rank : ranks.all) sum += rank.termination().work_balance();
  CHECK(sum == 0);

  CHECK_THROWS_AS(ranks.carry(1, hand_off), ProtocolError);
  CHECK_THROWS_AS(ranks[2].receive(1, SplitBatch{{{1, 1, 0, 2, {{5, 1}}}}}), ProtocolError);  // two hops in one move
  CHECK_THROWS_AS(ranks[2].hand_off(1, 2, {}), Error);
}

TEST_CASE("advice is delivered while there is work, and refused afterwards") {
  Ranks ranks;
  CHECK(ranks[0].advise(1, Plan{1, {{1, 2}}}));
  const Delivery delivery = ranks.carry(0, ranks.only(0));
  REQUIRE(delivery.advice);
  CHECK(*delivery.advice == Message(Plan{1, {{1, 2}}}));

  int carried = 0;
  for (bool moved = true; moved; ++carried) {
    REQUIRE(carried < 100);
    moved = false;
    for (Rank r = 0; r < 3; ++r) {
      ranks[r].rest(true);
      for (const Outgoing& outgoing : ranks[r].take_outgoing()) ranks.carry(r, outgoing), moved = true;
    }
  }
  for (const auto& rank : ranks.all) CHECK(rank.finished());
  CHECK(!ranks[0].advise(1, Plan{2, {}}));
  CHECK(ranks[0].take_outgoing().empty());
  CHECK_THROWS_AS(ranks[1].receive(0, SplitBatch{}), ProtocolError);
}
