#include "protocol/rank_protocol.hpp"

#include <doctest/doctest.h>

#include <cstdint>
#include <variant>
#include <vector>

#include "protocol/protocol_error.hpp"
#include "support/id_literals.hpp"

using namespace driftmesh;
using namespace driftmesh::protocol;
using Phase = Termination::Phase;

namespace {

// Three ranks; subdomain s starts on rank s. Messages are carried by hand, but the first probe, which is out at once.
struct Ranks {
  const IdVector<SubdomainId, Rank> owners{0_rank, 1_rank, 2_rank};
  IdVector<Rank, RankProtocol> all;
  Ranks() {
    for (const Rank r : first_ids<Rank>(3)) all.emplace_back(r, 3, owners, 4);
    for (const Outgoing& question : all[0_rank].take_outgoing()) carry(0_rank, question);
  }
  RankProtocol& operator[](Rank r) { return all[r]; }

  Delivery carry(Rank from, const Outgoing& outgoing) {
    return (*this)[outgoing.destination].receive(from, outgoing.message);
  }
  // The only message that a rank wants to send.
  Outgoing only(Rank from) {
    auto outgoing = (*this)[from].take_outgoing();
    REQUIRE(outgoing.size() == 1);
    return outgoing[0];
  }
  // All of them rest until nobody sends anything any more.
  void come_to_the_end() {
    int carried = 0;
    for (bool moved = true; moved; ++carried) {
      REQUIRE(carried < 100);
      moved = false;
      for (const Rank r : first_ids<Rank>(3)) {
        (*this)[r].rest(true);
        for (const Outgoing& outgoing : (*this)[r].take_outgoing()) carry(r, outgoing), moved = true;
      }
    }
  }
};

}  // namespace

TEST_CASE("SPLITs are sent when a batch is full or the rank is idle") {
  Ranks ranks;
  for (const GlobalRootId root : first_ids<GlobalRootId>(4)) ranks[0_rank].send_split(1_sub, {root, 1});
  ranks[0_rank].send_split(1_sub, {9_root, 3});
  auto delivery = ranks.carry(0_rank, ranks.only(0_rank));
  REQUIRE(delivery.splits.size() == 1);
  CHECK(delivery.splits[0].points.size() == 4);
  CHECK(ranks[0_rank].aggregated() == 1);
  CHECK(ranks[0_rank].termination().work_balance() == 5);
  CHECK(ranks[1_rank].termination().work_balance() == -4);
  ranks[0_rank].rest(false);
  delivery = ranks.carry(0_rank, ranks.only(0_rank));
  CHECK(delivery.splits[0].points == std::vector<SplitPoint<GlobalRootId>>{{9_root, 3}});
  CHECK(ranks[0_rank].counters().batches_sent == 2);
  CHECK_THROWS_AS(ranks[0_rank].send_split(0_sub, {1_root, 1}), Error);
}

TEST_CASE("a SPLIT follows its subdomain, the sender learns its owner, and counts match") {
  Ranks ranks;
  ranks[0_rank].send_split(1_sub, {5_root, 1});
  ranks[0_rank].rest(false);
  const Outgoing split = ranks.only(0_rank);
  ranks[1_rank].hand_off(1_sub, 2_rank, Bytes(3));
  const Outgoing hand_off = ranks.only(1_rank);
  CHECK(!ranks[1_rank].holds(1_sub));

  // It arrives at the former owner, is forwarded, and rank 0 gets a location update.
  CHECK(ranks.carry(0_rank, split).splits.empty());
  const auto sent = ranks[1_rank].take_outgoing();
  REQUIRE(sent.size() == 2);
  CHECK(sent[0].destination == 0_rank);
  CHECK(sent[0].message == Message(LocationUpdate{1_sub, 2_rank, 1}));
  ranks.carry(1_rank, sent[0]);
  CHECK(ranks[0_rank].where(1_sub) == Location{2_rank, 1});
  CHECK(ranks[1_rank].termination().work_balance() == 1);  // the hand-off, not what it forwarded

  // It overtakes the hand-off: held, and delivered with it.
  CHECK(ranks.carry(1_rank, sent[1]).splits.empty());
  CHECK(ranks[2_rank].held_groups() == 1);
  CHECK(ranks[2_rank].describe() ==
        "rank 2: working, probe 1 with the token, SPLITs and hand-offs sent less handled 0, 0 SPLITs in the "
        "aggregator, 1 groups held for subdomain 1");
  const Delivery delivery = ranks.carry(1_rank, hand_off);
  REQUIRE(delivery.arrival);
  CHECK(delivery.arrival->packed.size() == 3);
  REQUIRE(delivery.splits.size() == 1);
  CHECK(delivery.splits[0].origin == 0_rank);
  CHECK(delivery.splits[0].hops == 1);
  CHECK(ranks[2_rank].counters().most_hops == 1);
  CHECK(ranks[1_rank].counters().forwarded == 1);
  CHECK(ranks[2_rank].holds(1_sub));
  CHECK(ranks[2_rank].held_groups() == 0);
  std::int64_t sum = 0;
  for (const auto& rank : ranks.all) sum += rank.termination().work_balance();
  CHECK(sum == 0);

  CHECK_THROWS_AS(ranks.carry(1_rank, hand_off), ProtocolError);
  CHECK_THROWS_AS(ranks[2_rank].receive(1_rank, SplitBatch{{{1_sub, 1, 0_rank, 2, {{5_root, 1}}}}}),
                  ProtocolError);  // two hops in one move
  CHECK_THROWS_AS(ranks[2_rank].hand_off(1_sub, 2_rank, {}), Error);
}

TEST_CASE("each rank counts what it did, point by point and group by group") {
  Ranks ranks;
  for (const GlobalRootId root : first_ids<GlobalRootId>(3)) ranks[0_rank].send_split(1_sub, {root, 1});
  ranks[0_rank].rest(false);
  const Outgoing three = ranks.only(0_rank);
  ranks[1_rank].hand_off(1_sub, 2_rank, Bytes(7));
  const Outgoing first_move = ranks.only(1_rank);
  ranks.carry(0_rank, three);
  const auto forwarded = ranks[1_rank].take_outgoing();
  REQUIRE(forwarded.size() == 2);
  ranks.carry(1_rank, forwarded[0]);
  ranks.carry(1_rank, forwarded[1]);  // held
  ranks[0_rank].send_split(1_sub, {8_root, 1});
  ranks[0_rank].rest(false);
  const Outgoing direct = ranks.only(0_rank);
  CHECK(direct.destination == 2_rank);
  ranks.carry(0_rank, direct);  // held, too
  CHECK(ranks[2_rank].held_groups() == 2);
  CHECK(ranks[2_rank].counters().splits_handled == 0);
  const Delivery arrived = ranks.carry(1_rank, first_move);
  REQUIRE(arrived.splits.size() == 2);
  CHECK(arrived.splits[0].points == std::vector<SplitPoint<GlobalRootId>>{{0_root, 1}, {1_root, 1}, {2_root, 1}});
  CHECK(arrived.splits[1].points == std::vector<SplitPoint<GlobalRootId>>{{8_root, 1}});
  ranks[2_rank].hand_off(2_sub, 0_rank, Bytes(11));
  ranks[2_rank].hand_off(1_sub, 0_rank, Bytes(20));
  for (const Outgoing& move : ranks[2_rank].take_outgoing()) ranks.carry(2_rank, move);

  const auto counted = [&](Rank r) {
    const ProtocolCounters& c = ranks[r].counters();
    return std::vector<std::int64_t>{c.splits_sent, c.splits_handled, c.batches_sent, c.hand_offs, c.hand_off_bytes,
                                     c.arrivals,    c.forwarded,      c.most_hops,    c.held};
  };
  CHECK(counted(0_rank) == std::vector<std::int64_t>{4, 0, 2, 0, 0, 2, 0, 0, 0});
  CHECK(counted(1_rank) == std::vector<std::int64_t>{0, 0, 0, 1, 7, 0, 1, 0, 0});
  CHECK(counted(2_rank) == std::vector<std::int64_t>{0, 4, 0, 2, 31, 1, 0, 1, 2});
  std::int64_t sum = 0;
  for (const auto& rank : ranks.all) sum += rank.termination().work_balance();
  CHECK(sum == 0);
}

TEST_CASE("all others are told that a rank gives up the run, and nobody else") {
  Ranks ranks;
  ranks[1_rank].abandon();
  std::vector<Rank> told;
  for (const Outgoing& news : ranks[1_rank].take_outgoing()) {
    told.push_back(news.destination);
    CHECK(ranks.carry(1_rank, news).abandoned);
  }
  CHECK(told == std::vector<Rank>{0_rank, 2_rank});
}

TEST_CASE("a rank at work answers a probe once a subdomain has come, and an idle one not while a group waits for one") {
  Ranks ranks;
  const auto tokens_of = [&](Rank r) {
    int tokens = 0;
    for (const Outgoing& o : ranks[r].take_outgoing()) tokens += std::holds_alternative<Token>(o.message);
    return tokens;
  };
  ranks[0_rank].send_split(2_sub, {4_root, 1});
  ranks[0_rank].rest(false);
  ranks.carry(0_rank, ranks.only(0_rank));
  CHECK(tokens_of(2_rank) == 0);  // it has handled a SPLIT, and is at work
  ranks[1_rank].hand_off(1_sub, 2_rank, Bytes(1));
  const Outgoing move = ranks.only(1_rank);
  ranks[2_rank].receive(0_rank, SplitBatch{{{1_sub, 1, 0_rank, 1, {{5_root, 1}}}}});
  REQUIRE(ranks[2_rank].held_groups() == 1);
  ranks[2_rank].rest(true);
  CHECK(tokens_of(2_rank) == 0);
  ranks.carry(1_rank, move);
  CHECK(tokens_of(2_rank) == 1);
}

TEST_CASE("control messages that have come do not delay the end, and what they say afterward is not heard") {
  Ranks ranks;
  ranks[1_rank].advise(0_rank, LocationUpdate{2_sub, 2_rank, 0});
  ranks[0_rank].advise(2_rank, Advice{1, Bytes(2)});
  ranks[2_rank].abandon();
  ranks.come_to_the_end();
  for (const Rank r : first_ids<Rank>(3)) {
    CHECK(ranks[r].finished());
    CHECK(!ranks[r].receive(0_rank, Advice{1, Bytes(2)}).advice);
  }
}

TEST_CASE("who misled a SPLIT is told where its subdomain is, and only who does not know") {
  Ranks ranks;
  ranks[1_rank].hand_off(1_sub, 2_rank, Bytes(1));
  const Outgoing move = ranks.only(1_rank);
  ranks.carry(1_rank, move);
  ranks[2_rank].hand_off(1_sub, 0_rank, Bytes(1));
  Outgoing second;
  for (const Outgoing& o : ranks[2_rank].take_outgoing())  // beside the answer to a probe
    if (std::holds_alternative<HandOff>(o.message)) second = o;
  const auto told_by = [&](Rank r) {
    std::vector<Rank> told;
    for (const Outgoing& o : ranks[r].take_outgoing())
      if (std::holds_alternative<LocationUpdate>(o.message)) told.push_back(o.destination);
    return told;
  };
  // Made by rank 1 when the subdomain was on rank 2: that tells rank 1, and not itself or rank 0, which has it.
  ranks[2_rank].receive(1_rank, SplitBatch{{{1_sub, 1, 1_rank, 0, {{5_root, 1}}}}});
  CHECK(told_by(2_rank) == std::vector<Rank>{1_rank});
  // Made by rank 0 once, forwarded by rank 1: the new owner knows.
  ranks[2_rank].receive(1_rank, SplitBatch{{{1_sub, 1, 0_rank, 1, {{6_root, 1}}}}});
  CHECK(told_by(2_rank) == std::vector<Rank>{1_rank});
  // Made here before it came and went.
  ranks[2_rank].receive(1_rank, SplitBatch{{{1_sub, 1, 2_rank, 1, {{7_root, 1}}}}});
  CHECK(told_by(2_rank) == std::vector<Rank>{1_rank});
  ranks.carry(2_rank, second);
  CHECK(ranks[0_rank].holds(1_sub));
}

TEST_CASE("advice is delivered while there is work, and rejected afterward") {
  Ranks ranks;
  CHECK(ranks[0_rank].advise(1_rank, Advice{3, Bytes(5)}));
  const Delivery delivery = ranks.carry(0_rank, ranks.only(0_rank));
  REQUIRE(delivery.advice);
  CHECK(*delivery.advice == Advice{3, Bytes(5)});

  ranks.come_to_the_end();
  for (const auto& rank : ranks.all) CHECK(rank.finished());
  CHECK(!ranks[0_rank].advise(1_rank, Advice{}));
  CHECK(ranks[0_rank].take_outgoing().empty());
  CHECK_THROWS_AS(ranks[1_rank].receive(0_rank, SplitBatch{}), ProtocolError);
}
