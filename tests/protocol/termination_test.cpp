#include "protocol/termination.hpp"

#include <doctest/doctest.h>

#include "protocol/protocol_error.hpp"
#include "support/id_literals.hpp"

using namespace driftmesh;
using namespace driftmesh::protocol;
using Phase = Termination::Phase;

namespace {

// Lets every rank advance, all passive, and carries what they send, until nothing moves. Returns the messages carried.
int settle(IdVector<Rank, Termination>& ranks) {
  int carried = 0;
  for (bool moved = true; moved;) {
    moved = false;
    for (const Rank source : ids_of(ranks)) {
      const auto sent = ranks[source].advance(true);
      if (!sent) continue;
      moved = true;
      REQUIRE(++carried < 10000);
      auto& to = ranks[sent->destination];
      if (const auto* token = std::get_if<Token>(&sent->message)) to.receive(source, *token);
      if (const auto* terminate = std::get_if<Terminate>(&sent->message)) to.receive(source, *terminate);
      if (const auto* finish = std::get_if<Finish>(&sent->message)) to.receive(source, *finish);
    }
  }
  return carried;
}

IdVector<Rank, Termination> make(std::int32_t ranks) {
  IdVector<Rank, Termination> all;
  for (const Rank r : first_ids<Rank>(ranks)) all.emplace_back(r, ranks);
  return all;
}

}  // namespace

TEST_CASE("ranks without any work finish after one probe, one pass and one farewell") {
  for (std::int32_t ranks = 1; ranks <= 9; ++ranks) {
    CAPTURE(ranks);
    auto all = make(ranks);
    CHECK(settle(all) == (ranks == 1 ? 0 : 3 * ranks - 1));
    for (const auto& rank : all) CHECK(rank.phase() == Phase::kFinished);
  }
}

TEST_CASE("the end of work is detected within two more probes") {
  auto all = make(4);
  all[1_rank].work_sent(5);
  all[3_rank].work_handled(5);
  settle(all);
  for (const auto& rank : all) CHECK(rank.phase() == Phase::kFinished);
  CHECK(all[0_rank].rounds() == 2);
}

TEST_CASE("no termination while a message is under way or a rank is busy") {
  auto all = make(3);
  all[2_rank].work_sent(1);
  CHECK(!all[0_rank].advance(false));
  for (int round = 0; round < 5; ++round) {
    Message message = all[0_rank].advance(true).value().message;
    for (const auto& [from, to] : {std::pair(0_rank, 1_rank), {1_rank, 2_rank}, {2_rank, 0_rank}}) {
      auto& rank = all[to];
      rank.receive(from, std::get<Token>(message));
      if (to == 0_rank) break;
      CHECK(!rank.advance(false));
      message = rank.advance(true).value().message;
    }
    CHECK(std::get<Token>(message).count == 1);
  }
  CHECK(all[0_rank].phase() == Phase::kWorking);
  all[0_rank].work_handled(1);
  settle(all);
  CHECK(all[0_rank].phase() == Phase::kFinished);
}

TEST_CASE("a single rank waits for messages to itself") {
  Termination rank(0_rank, 1);
  rank.work_sent(2);
  rank.control_sent();
  CHECK(!rank.advance(true));
  CHECK(rank.phase() == Phase::kWorking);
  rank.work_handled(2);
  CHECK(!rank.advance(false));
  CHECK(rank.phase() == Phase::kWorking);
  CHECK(!rank.advance(true));
  CHECK(rank.phase() == Phase::kDraining);
  rank.control_received();
  CHECK(!rank.advance(true));
  CHECK(rank.phase() == Phase::kFinished);
}

TEST_CASE("the fence waits for control messages under way") {
  auto all = make(2);
  all[1_rank].control_sent();
  Token token = std::get<Token>(all[0_rank].advance(true)->message);
  all[1_rank].receive(0_rank, token);
  all[0_rank].receive(1_rank, std::get<Token>(all[1_rank].advance(true)->message));
  for (std::uint64_t pass = 1; pass <= 5; ++pass) {
    const auto terminate = std::get<Terminate>(all[0_rank].advance(true)->message);
    CHECK(terminate.pass == pass);
    CHECK(all[0_rank].phase() == Phase::kDraining);
    all[1_rank].receive(0_rank, terminate);
    const auto back = std::get<Terminate>(all[1_rank].advance(true)->message);
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
  const auto token = std::get<Token>(all[0_rank].advance(true)->message);
  all[1_rank].receive(0_rank, token);
  all[1_rank].receive(0_rank, token);
  CHECK(all[1_rank].advance(true));
  all[1_rank].receive(0_rank, token);
  CHECK(!all[1_rank].advance(true));
  CHECK_THROWS_AS(all[1_rank].receive(0_rank, Token{3, 0, false}), ProtocolError);
  CHECK_THROWS_AS(all[1_rank].receive(0_rank, Finish{}), ProtocolError);
  CHECK_THROWS_AS(all[0_rank].receive(2_rank, Terminate{1, 0, 0}), ProtocolError);
}

TEST_CASE("the audit detects premature termination") {
  auto all = make(2);
  Token token = std::get<Token>(all[0_rank].advance(true)->message);
  all[1_rank].receive(0_rank, token);
  all[0_rank].receive(1_rank, std::get<Token>(all[1_rank].advance(true)->message));
  all[1_rank].receive(0_rank, std::get<Terminate>(all[0_rank].advance(true)->message));
  auto back = std::get<Terminate>(all[1_rank].advance(true)->message);
  back.work = 1;
  all[0_rank].receive(1_rank, back);
  CHECK_THROWS_WITH_AS(all[0_rank].advance(true),
                       "message from rank 1: after termination 1 SPLITs or hand-offs are sent and not handled: "
                       "termination was wrong",
                       ProtocolError);
}

TEST_CASE("a passive rank must not send work") {
  Termination rank(1_rank, 2);
  rank.work_sent(1);
  CHECK(!rank.advance(true));
  CHECK_THROWS_AS(rank.work_sent(1), Error);
  rank.work_handled(1);
  rank.work_sent(1);
  CHECK(rank.work_balance() == 1);
}
