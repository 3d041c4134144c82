#include "protocol/termination.hpp"

#include <doctest/doctest.h>

#include "protocol/protocol_error.hpp"

using namespace driftmesh;
using namespace driftmesh::protocol;
using Phase = Termination::Phase;

namespace {

// Lets every rank advance, all passive, and carries what they send, until nothing moves. Returns the messages carried.
int settle(std::vector<Termination>& ranks) {
  int carried = 0;
  for (bool moved = true; moved;) {
    moved = false;
    for (std::size_t r = 0; r < ranks.size(); ++r) {
      const auto sent = ranks[r].advance(true);
      if (!sent) continue;
      moved = true;
      REQUIRE(++carried < 10000);
      auto& to = ranks[static_cast<std::size_t>(sent->destination)];
      const auto source = static_cast<Rank>(r);
      if (const auto* token = std::get_if<Token>(&sent->message)) to.receive(source, *token);
      if (const auto* terminate = std::get_if<Terminate>(&sent->message)) to.receive(source, *terminate);
      if (const auto* finish = std::get_if<Finish>(&sent->message)) to.receive(source, *finish);
    }
  }
  return carried;
}

std::vector<Termination> make(Rank ranks) {
  std::vector<Termination> all;
  for (Rank r = 0; r < ranks; ++r) all.emplace_back(r, ranks);
  return all;
}

}  // namespace

TEST_CASE("ranks without any work finish: one probe, one pass, one farewell") {
  for (Rank ranks = 1; ranks <= 9; ++ranks) {
    CAPTURE(ranks);
    auto all = make(ranks);
    CHECK(settle(all) == (ranks == 1 ? 0 : 3 * ranks - 1));
    for (const auto& rank : all) CHECK(rank.phase() == Phase::kFinished);
  }
}

TEST_CASE("handled work is noticed within two more probes") {
  auto all = make(4);
  all[1].work_sent(5);
  all[3].work_handled(5);
  settle(all);
  for (const auto& rank : all) CHECK(rank.phase() == Phase::kFinished);
  CHECK(all[0].rounds() == 2);
}

TEST_CASE("no end while work is under way, and none while a rank is busy") {
  auto all = make(3);
  all[2].work_sent(1);
  CHECK(!all[0].advance(false));
  for (int round = 0; round < 5; ++round) {
    Message message = all[0].advance(true).value().message;
    for (Rank r : {1, 2, 0}) {
      auto& rank = all[static_cast<std::size_t>(r)];
      rank.receive((r + 2) % 3, std::get<Token>(message));
      if (r == 0) break;
      CHECK(!rank.advance(false));
      message = rank.advance(true).value().message;
    }
    CHECK(std::get<Token>(message).count == 1);
  }
  CHECK(all[0].phase() == Phase::kWorking);
  all[0].work_handled(1);
  settle(all);
  CHECK(all[0].phase() == Phase::kFinished);
}

TEST_CASE("one rank alone waits for what it sent to itself") {
  Termination rank(0, 1);
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
  all[1].control_sent();
  Token token = std::get<Token>(all[0].advance(true)->message);
  all[1].receive(0, token);
  all[0].receive(1, std::get<Token>(all[1].advance(true)->message));
  for (std::uint64_t pass = 1; pass <= 5; ++pass) {
    const auto terminate = std::get<Terminate>(all[0].advance(true)->message);
    CHECK(terminate.pass == pass);
    CHECK(all[0].phase() == Phase::kDraining);
    all[1].receive(0, terminate);
    const auto back = std::get<Terminate>(all[1].advance(true)->message);
    CHECK(back.control == 1);
    all[0].receive(1, back);
    all[0].receive(1, back);
  }
  all[0].control_received();
  settle(all);
  for (const auto& rank : all) CHECK(rank.phase() == Phase::kFinished);
}

TEST_CASE("copies of detection messages change nothing, impossible ones are errors") {
  auto all = make(3);
  const auto token = std::get<Token>(all[0].advance(true)->message);
  all[1].receive(0, token);
  all[1].receive(0, token);
  CHECK(all[1].advance(true));
  all[1].receive(0, token);
  CHECK(!all[1].advance(true));
  CHECK_THROWS_AS(all[1].receive(0, Token{3, 0, false}), ProtocolError);
  CHECK_THROWS_AS(all[1].receive(0, Finish{}), ProtocolError);
  CHECK_THROWS_AS(all[0].receive(2, Terminate{1, 0, 0}), ProtocolError);
}

TEST_CASE("the audit finds an end that was declared too early") {
  auto all = make(2);
  Token token = std::get<Token>(all[0].advance(true)->message);
  all[1].receive(0, token);
  all[0].receive(1, std::get<Token>(all[1].advance(true)->message));
  all[1].receive(0, std::get<Terminate>(all[0].advance(true)->message));
  auto back = std::get<Terminate>(all[1].advance(true)->message);
  back.work = 1;
  all[0].receive(1, back);
  CHECK_THROWS_WITH_AS(all[0].advance(true),
                       "message from rank 1: after termination 1 SPLITs or hand-offs are sent and not handled: "
                       "termination was wrong",
                       ProtocolError);
}

TEST_CASE("a passive rank must not send work") {
  Termination rank(1, 2);
  rank.work_sent(1);
  CHECK(!rank.advance(true));
  CHECK_THROWS_AS(rank.work_sent(1), Error);
  rank.work_handled(1);
  rank.work_sent(1);
  CHECK(rank.work_balance() == 1);
}
