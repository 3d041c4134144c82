#include "protocol/termination.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "protocol/protocol_error.hpp"
#include "support/id_literals.hpp"

using namespace driftmesh;
using namespace driftmesh::protocol;
using Phase = Termination::Phase;

namespace {

std::vector<Outgoing> advance(Termination& rank, bool passive) {
  std::vector<Outgoing> out;
  rank.advance(passive, out);
  return out;
}

// The only message that a rank sends, which must be a T.
template <class T>
T only(Termination& rank, bool passive = true) {
  const auto out = advance(rank, passive);
  REQUIRE(out.size() == 1);
  return std::get<T>(out.front().message);
}

void deliver(IdVector<Rank, Termination>& ranks, Rank source, const Outgoing& sent) {
  auto& to = ranks[sent.destination];
  if (const auto* token = std::get_if<Token>(&sent.message)) to.receive(source, *token);
  if (const auto* terminate = std::get_if<Terminate>(&sent.message)) to.receive(source, *terminate);
  if (const auto* finish = std::get_if<Finish>(&sent.message)) to.receive(source, *finish);
}

// What rank 0 asks reaches the others.
void ask(IdVector<Rank, Termination>& ranks, bool passive) {
  for (const Outgoing& question : advance(ranks[0_rank], passive)) deliver(ranks, 0_rank, question);
}

// Lets every rank advance, all passive, and carries what they send, until nothing moves. Returns the messages carried.
int settle(IdVector<Rank, Termination>& ranks) {
  int carried = 0;
  for (bool moved = true; moved;) {
    moved = false;
    for (const Rank source : ids_of(ranks))
      for (const Outgoing& sent : advance(ranks[source], true)) {
        moved = true;
        REQUIRE(++carried < 100000);
        deliver(ranks, source, sent);
      }
  }
  return carried;
}

// The steps of time, each the latency of a message, until all passive ranks have finished.
int latencies(IdVector<Rank, Termination>& ranks) {
  for (int steps = 0;; ++steps) {
    REQUIRE(steps < 1000);
    std::vector<std::pair<Rank, Outgoing>> in_transit;
    for (const Rank source : ids_of(ranks))
      for (Outgoing& sent : advance(ranks[source], true)) in_transit.emplace_back(source, std::move(sent));
    if (in_transit.empty()) return steps;
    for (const auto& [source, sent] : in_transit) deliver(ranks, source, sent);
  }
}

IdVector<Rank, Termination> make(std::int32_t ranks, std::int32_t arity = TreePlace::kMostChildren) {
  IdVector<Rank, Termination> all;
  for (const Rank r : first_ids<Rank>(ranks)) all.emplace_back(r, ranks, arity);
  return all;
}

}  // namespace

TEST_CASE("ranks without any work finish after one probe, one pass and one farewell") {
  for (const std::int32_t arity : {1, 2, 8, 64})
    for (const std::int32_t ranks : {1, 2, 3, 8, 9, 10, 17, 64, 65, 66, 73, 74, 600}) {
      CAPTURE(arity);
      CAPTURE(ranks);
      auto all = make(ranks, arity);
      CHECK(settle(all) == 5 * (ranks - 1));
      for (const auto& rank : all) CHECK(rank.phase() == Phase::kFinished);
    }
}

TEST_CASE("the end takes latencies in proportion to the height of the tree") {
  const auto check = [](std::int32_t ranks, std::int32_t arity, int height) {
    CAPTURE(ranks);
    CAPTURE(arity);
    auto all = make(ranks, arity);
    CHECK(latencies(all) == 5 * height);
  };
  for (const auto& [ranks, height] : {std::pair(2, 1), {65, 1}, {66, 2}, {144, 2}, {4096, 2}, {4161, 2}, {4162, 3}})
    check(ranks, 64, height);
  for (const auto& [ranks, height] : {std::pair(9, 1), {10, 2}, {73, 2}, {74, 3}}) check(ranks, 8, height);
  check(10, 1, 9);
}

TEST_CASE("the end of work is detected within two more probes") {
  auto all = make(4);
  all[1_rank].work_sent(5);
  all[3_rank].work_handled(5);
  settle(all);
  for (const auto& rank : all) CHECK(rank.phase() == Phase::kFinished);
  CHECK(all[0_rank].rounds() == 2);
}

TEST_CASE("the tree of ranks reaches each rank once, and each knows its own children") {
  for (const std::int32_t arity : {1, 2, 3, 64})
    for (const std::int32_t ranks : {1, 2, 3, 4, 7, 8, 65, 66, 130}) {
      CAPTURE(arity);
      CAPTURE(ranks);
      IdVector<Rank, int> reached(static_cast<std::size_t>(ranks), 0);
      for (const Rank r : ids_of(reached)) {
        const TreePlace place(r, ranks, arity);
        CHECK(place.is_root() == (r == 0_rank));
        CHECK(place.children() <= static_cast<std::size_t>(arity));
        std::set<Rank> below;
        for (std::size_t i = 0; i < place.children(); ++i) {
          const Rank child = place.child(i);
          REQUIRE(reached.has(child));
          ++reached[child];
          below.insert(child);
          CHECK(place.child_number(child) == i);
          CHECK(TreePlace(child, ranks, arity).parent() == r);
        }
        for (const Rank other : ids_of(reached))
          if (below.count(other) == 0) CHECK(!place.child_number(other));
      }
      CHECK(std::count(reached.begin(), reached.end(), 1) == ranks - 1);
      CHECK(reached[0_rank] == 0);
    }
}

TEST_CASE("a wave adds up each answer to its question once, whatever copies of older ones come") {
  Wave<Token> wave(0_rank, 3, 2);
  std::vector<Outgoing> out;
  for (std::uint64_t round = 1; round <= 4; ++round) {
    CAPTURE(round);
    wave.ask();
    CHECK(wave.round() == round);
    wave.relay(out);
    wave.relay(out);
    CHECK(std::exchange(out, {}).size() == 2);
    for (const Rank r : {2_rank, 1_rank, 2_rank, 1_rank}) {
      for (std::uint64_t old = 1; old < round; ++old) CHECK(!wave.receive(r, Token{old, 1000, true}));
      CHECK(wave.due() == (wave.so_far().count == 30));
      CHECK(!wave.receive(r, Token{round, r == 1_rank ? 10 : 20, false}));
    }
    CHECK_THROWS_AS(wave.receive(1_rank, Token{round + 1, 0, false}), ProtocolError);
    CHECK_THROWS_AS(wave.receive(0_rank, Token{round, 0, false}), ProtocolError);
    CHECK_THROWS_AS(wave.receive(3_rank, Token{round, 0, false}), ProtocolError);
    REQUIRE(wave.due());
    CHECK(wave.close(Token{round, 5, false}) == Token{round, 35, false});
    CHECK(!wave.asked());
    CHECK(!wave.due());
  }
}

TEST_CASE("no termination while a message is under way or a rank is busy") {
  auto all = make(3);
  all[2_rank].work_sent(1);
  ask(all, false);
  for (int round = 0; round < 5; ++round) {
    for (const Rank r : {2_rank, 1_rank}) {
      CHECK(advance(all[r], false).empty());
      CHECK(advance(all[0_rank], true).empty());
      const auto token = only<Token>(all[r]);
      CHECK(token.count == (r == 2_rank ? 1 : 0));
      all[0_rank].receive(r, token);
    }
    CHECK(advance(all[0_rank], false).empty());
    ask(all, true);
  }
  CHECK(all[0_rank].phase() == Phase::kWorking);
  all[0_rank].work_handled(1);
  settle(all);
  CHECK(all[0_rank].phase() == Phase::kFinished);
}

TEST_CASE("a rank at work passes a question on, and answers when it is passive and the ranks below have answered") {
  auto all = make(11, 8);  // 9 and 10 are below 1
  ask(all, false);
  const auto asked = advance(all[1_rank], false);
  REQUIRE(asked.size() == 2);
  for (const Outgoing& question : asked) deliver(all, 1_rank, question);
  all[9_rank].work_sent(3);
  all[10_rank].work_sent(1);
  const auto nine = only<Token>(all[9_rank]);
  all[1_rank].receive(9_rank, nine);
  all[1_rank].receive(9_rank, nine);  // a copy is not a second answer
  CHECK(advance(all[1_rank], true).empty());
  all[1_rank].receive(10_rank, only<Token>(all[10_rank]));
  CHECK(advance(all[1_rank], false).empty());
  CHECK(only<Token>(all[1_rank]) == Token{1, 4, false});
}

TEST_CASE("a rank at work answers a probe that fails anyway") {
  auto all = make(3, 1);  // 2 is below 1
  ask(all, false);
  for (const Outgoing& question : advance(all[1_rank], false)) deliver(all, 1_rank, question);
  SUBCASE("since a rank below is black") {
    all[2_rank].work_handled(1);
    CHECK(advance(all[2_rank], false).empty());  // handling SPLITs goes on all the time
    all[1_rank].receive(2_rank, only<Token>(all[2_rank]));
    CHECK(only<Token>(all[1_rank], false) == Token{1, -1, true});
  }
  SUBCASE("since it has received a subdomain") {
    all[2_rank].subdomain_handled();
    all[1_rank].receive(2_rank, only<Token>(all[2_rank], false));
    CHECK(only<Token>(all[1_rank], false) == Token{1, -1, true});
  }
  SUBCASE("once") {
    all[2_rank].subdomain_handled();
    all[1_rank].receive(2_rank, only<Token>(all[2_rank], false));
    all[0_rank].receive(1_rank, only<Token>(all[1_rank], false));
    CHECK(only<Token>(all[0_rank], false).round == 2);
    all[1_rank].receive(0_rank, Token{2, 0, false});
    all[2_rank].receive(1_rank, only<Token>(all[1_rank], false));
    CHECK(advance(all[2_rank], false).empty());
    CHECK(only<Token>(all[2_rank]) == Token{2, -1, false});
  }
}

TEST_CASE("moves during the work do not delay its end") {
  // Rank 3 is at work longest, and all others have received something before.
  auto all = make(6);
  ask(all, false);
  for (const Rank r : {1_rank, 2_rank, 4_rank, 5_rank}) {
    all[3_rank].work_sent(1);
    all[r].subdomain_handled();
  }
  all[0_rank].work_sent(1);
  all[3_rank].subdomain_handled();
  for (int step = 0; step < 6; ++step)
    for (const Rank source : ids_of(all))
      for (const Outgoing& sent : advance(all[source], source != 3_rank)) deliver(all, source, sent);
  CHECK(all[0_rank].phase() == Phase::kWorking);
  CHECK(latencies(all) == 4);  // the answer, a pass there and back, and the farewell
}

TEST_CASE("a single rank waits for messages to itself") {
  Termination rank(0_rank, 1);
  rank.work_sent(2);
  rank.control_sent();
  CHECK(advance(rank, true).empty());
  CHECK(rank.phase() == Phase::kWorking);
  rank.work_handled(2);
  CHECK(advance(rank, false).empty());
  CHECK(rank.phase() == Phase::kWorking);
  CHECK(advance(rank, true).empty());
  CHECK(rank.phase() == Phase::kDraining);
  rank.control_received();
  CHECK(advance(rank, true).empty());
  CHECK(rank.phase() == Phase::kFinished);
}

TEST_CASE("the fence waits for control messages under way") {
  auto all = make(2);
  all[1_rank].control_sent();
  Token token = only<Token>(all[0_rank]);
  all[1_rank].receive(0_rank, token);
  all[0_rank].receive(1_rank, only<Token>(all[1_rank]));
  for (std::uint64_t pass = 1; pass <= 5; ++pass) {
    const auto terminate = only<Terminate>(all[0_rank]);
    CHECK(terminate.round == pass);
    CHECK(all[0_rank].phase() == Phase::kDraining);
    all[1_rank].receive(0_rank, terminate);
    const auto back = only<Terminate>(all[1_rank]);
    CHECK(back.control == 1);
    all[0_rank].receive(1_rank, back);
    all[0_rank].receive(1_rank, back);
  }
  all[0_rank].control_received();
  settle(all);
  for (const auto& rank : all) CHECK(rank.phase() == Phase::kFinished);
}

TEST_CASE("copies of detection messages change nothing, impossible ones are errors") {
  auto all = make(3);
  CHECK(advance(all[0_rank], true).size() == 2);
  const Token token{1, 0, false};
  all[1_rank].receive(0_rank, token);
  all[1_rank].receive(0_rank, token);
  CHECK(only<Token>(all[1_rank]) == token);
  all[1_rank].receive(0_rank, token);
  CHECK(advance(all[1_rank], true).empty());
  CHECK_THROWS_AS(all[1_rank].receive(0_rank, Token{3, 0, false}), ProtocolError);
  CHECK_THROWS_AS(all[1_rank].receive(2_rank, Token{2, 0, false}), ProtocolError);
  CHECK_THROWS_AS(all[0_rank].receive(2_rank, Token{2, 0, false}), ProtocolError);
  CHECK_THROWS_AS(all[1_rank].receive(0_rank, Finish{}), ProtocolError);
  CHECK_THROWS_AS(all[0_rank].receive(2_rank, Terminate{1, 0, 0}), ProtocolError);
}

TEST_CASE("the audit detects premature termination") {
  auto all = make(2);
  Token token = only<Token>(all[0_rank]);
  all[1_rank].receive(0_rank, token);
  all[0_rank].receive(1_rank, only<Token>(all[1_rank]));
  all[1_rank].receive(0_rank, only<Terminate>(all[0_rank]));
  auto back = only<Terminate>(all[1_rank]);
  back.work = 1;
  all[0_rank].receive(1_rank, back);
  CHECK_THROWS_WITH_AS(advance(all[0_rank], true),
                       "after termination 1 SPLITs or hand-offs are sent and not handled: termination was wrong",
                       Error);
}

TEST_CASE("a passive rank must not send work") {
  Termination rank(1_rank, 2);
  rank.work_sent(1);
  CHECK(advance(rank, true).empty());
  CHECK_THROWS_AS(rank.work_sent(1), Error);
  rank.work_handled(1);
  rank.work_sent(1);
  CHECK(rank.work_balance() == 1);
}
