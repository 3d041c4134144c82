// Two ranks that ask each other for memory, told by hand what they have.
#include <doctest/doctest.h>

#include <map>
#include <variant>
#include <vector>

#include "balancer/admissions.hpp"
#include "protocol/packed_size.hpp"
#include "support/id_literals.hpp"
#include "support/load_snapshots.hpp"

using namespace driftmesh;
using namespace driftmesh::balancer;
using namespace driftmesh::testing;
using Stage = Admission::Stage;

namespace {

std::vector<ReportedLoad> loads(const std::vector<double>& work) {
  std::vector<ReportedLoad> own;
  for (std::size_t i = 0; i < work.size(); ++i) own.push_back({static_cast<SubdomainId>(i), 0, work[i], 0});
  return own;
}

Admission step_of(const Outgoing& message) {
  return std::get<Admission>(message.message);
}

/// Rank 0, which gives, and rank 1, which is short of memory.
struct Pair {
  Admissions giver{0_rank}, receiver{1_rank};
  std::vector<ReportedLoad> own, nothing;
  explicit Pair(const std::vector<double>& work) : own(loads(work)) {}

  /// The giver asks for all subdomains up to `last`; what the receiver answers given that memory.
  Admissions::Settled ask(SubdomainId last, double free_memory) {
    std::vector<Move> moves;
    for (const SubdomainId s : first_ids<SubdomainId>(to_int(last) + 1)) moves.push_back({s, 1_rank});
    const auto questions = giver.ask(moves, own);
    REQUIRE(questions.size() == 1);
    CHECK(questions[0].destination == 1_rank);
    CHECK(step_of(questions[0]).stage == Stage::kAsk);
    receiver.receive(0_rank, step_of(questions[0]));
    return receiver.settle(free_memory, nothing);
  }
  Admissions::Settled follow(const Admissions::Settled& answered) {
    REQUIRE(answered.messages.size() == 1);
    CHECK(answered.messages[0].destination == 0_rank);
    giver.receive(1_rank, step_of(answered.messages[0]));
    return giver.settle(0, own);
  }
};

}  // namespace

TEST_CASE("a rank is asked if what comes, times those that may send, is more than it has free") {
  LoadSnapshot s = initial_snapshot(grid_layout(6, 1, 3), {1, 1, 1});
  for (SubdomainLoad& load : s.subdomains) load.remaining = 100, load.bytes = 20 * protocol::kBytesPerTriangle;
  const std::vector<Move> moves{{0_sub, 1_rank}, {1_sub, 1_rank}, {2_sub, 2_rank}, {99_sub, 0_rank}};
  const auto asked = [&](double free_one, double free_two, const std::map<Rank, double>& coming, double givers) {
    s.ranks[1_rank].free_memory = free_one;
    s.ranks[2_rank].free_memory = free_two;
    return short_of_memory(s, moves, coming, givers);
  };
  const auto none = std::vector<Rank>{}, one = std::vector{1_rank}, both = std::vector{1_rank, 2_rank};
  CHECK(asked(240, 120, {}, 1) == none);
  CHECK(asked(239, 120, {}, 1) == one);
  CHECK(asked(239, 119, {}, 1) == both);
  CHECK(asked(480, 240, {}, 2) == none);
  CHECK(asked(479, 240, {}, 2) == one);
  // 60 on their way have been taken off, but may come twice: free are 540 of 600, and 300 by two givers are needed.
  CHECK(asked(540, 240, {{1_rank, 60}}, 2) == none);
  CHECK(asked(539, 240, {{1_rank, 60}}, 2) == one);
}

TEST_CASE("whoever fits is admitted, memory is set aside for it, and what leaves is gone from the load") {
  Pair ranks({100, 300, 50, 70});
  CHECK(!ranks.giver.waiting());
  const auto answered = ranks.ask(2_sub, 150);
  CHECK(ranks.giver.waiting());
  CHECK(!ranks.giver.pressing());
  CHECK(step_of(answered.messages[0]) == Admission{1, Stage::kAnswer, {{0_sub, 100}, {2_sub, 50}}});
  CHECK(answered.refused);
  CHECK(answered.not_coming == std::vector<SubdomainId>{1_sub});
  CHECK(ranks.receiver.set_aside() == 150);

  auto meanwhile = ranks.own;  // what waits for an answer is not to be given to others
  CHECK(ranks.giver.settle(0, meanwhile).messages.empty());
  REQUIRE(meanwhile.size() == 1);
  CHECK(meanwhile[0].subdomain == 3_sub);

  const auto followed = ranks.follow(answered);
  CHECK(followed.moves == std::vector<Move>{{0_sub, 1_rank}, {2_sub, 1_rank}});
  CHECK(followed.messages.empty());
  REQUIRE(ranks.own.size() == 2);
  CHECK(ranks.own[0].subdomain == 1_sub);
  CHECK(!ranks.giver.waiting());

  ranks.receiver.arrived(0_sub);
  CHECK(ranks.receiver.set_aside() == 50);
  ranks.receiver.arrived(0_sub);
  ranks.receiver.arrived(2_sub);
  CHECK(ranks.receiver.set_aside() == 0);
}

TEST_CASE("memory that is set aside is not free for the next, and all that is free can be used") {
  Pair ranks({100, 100});
  CHECK(!ranks.ask(0_sub, 150).refused);
  Admissions third(2_rank);
  const auto other = loads({50, 1});
  const std::vector<Move> moves{{0_sub, 1_rank}, {1_sub, 1_rank}};
  ranks.receiver.receive(2_rank, step_of(third.ask(moves, other)[0]));
  CHECK(ranks.receiver.pressing());
  const auto answered = ranks.receiver.settle(150, ranks.nothing);
  CHECK(answered.messages[0].destination == 2_rank);
  CHECK(step_of(answered.messages[0]).guests == std::vector<Admission::Guest>{{0_sub, 50}});
  CHECK(answered.not_coming == std::vector<SubdomainId>{1_sub});
  CHECK(ranks.receiver.set_aside() == 150);
}

TEST_CASE("what was admitted and does not come is returned, and its memory is free again") {
  Pair ranks({100, 100, 100, 100});
  const auto answered = ranks.ask(3_sub, 1000);
  ranks.own[0].remaining = 105;            // within what it asked for
  ranks.own[1].remaining = 106;            // needs more
  ranks.own.erase(ranks.own.begin() + 2);  // finished
  const auto followed = ranks.follow(answered);
  CHECK(followed.moves == std::vector<Move>{{0_sub, 1_rank}, {3_sub, 1_rank}});
  CHECK(followed.gone == std::vector<SubdomainId>{2_sub});
  REQUIRE(followed.messages.size() == 2);
  ranks.giver.stayed(3_sub);  // it could not be handed over
  ranks.giver.stayed(1_sub);  // was not to move at all
  CHECK(ranks.giver.pressing());
  const auto said = ranks.giver.settle(0, ranks.own);
  REQUIRE(said.messages.size() == 1);
  CHECK(!ranks.giver.waiting());
  CHECK(step_of(said.messages[0]) == Admission{1, Stage::kReturn, {{3_sub, 100}}});

  Admission stranger = step_of(said.messages[0]);
  ranks.receiver.receive(2_rank, stranger);  // nothing was asked for by that rank
  stranger.round = 9;
  ranks.receiver.receive(0_rank, stranger);
  CHECK(ranks.receiver.settle(1000, ranks.nothing).not_coming.empty());
  CHECK(ranks.receiver.set_aside() == 400);
  for (const Outgoing& back : followed.messages) ranks.receiver.receive(0_rank, step_of(back));
  CHECK(ranks.receiver.settle(1000, ranks.nothing).not_coming == std::vector<SubdomainId>{1_sub, 2_sub});
  CHECK(ranks.receiver.set_aside() == 200);
  ranks.receiver.receive(0_rank, step_of(said.messages[0]));
  CHECK(ranks.receiver.settle(1000, ranks.nothing).not_coming == std::vector<SubdomainId>{3_sub});
  CHECK(ranks.receiver.set_aside() == 100);
}

TEST_CASE("only the answer of that rank to that question counts, and questions have numbers of their own") {
  Admissions giver(0_rank);
  std::vector<ReportedLoad> own = loads({10, 10, 10});
  const std::vector<Move> moves{{0_sub, 1_rank}, {1_sub, 2_rank}, {2_sub, 2_rank}, {7_sub, 1_rank}};
  const auto first = giver.ask(moves, own);
  REQUIRE(first.size() == 2);
  CHECK(step_of(first[0]) == Admission{1, Stage::kAsk, {{0_sub, 10}}});
  CHECK(step_of(first[1]) == Admission{2, Stage::kAsk, {{1_sub, 10}, {2_sub, 10}}});
  giver.receive(2_rank, Admission{1, Stage::kAnswer, {{0_sub, 10}}});
  giver.receive(1_rank, Admission{2, Stage::kAnswer, {{1_sub, 10}}});
  auto same = own;
  CHECK(giver.settle(0, same).moves.empty());
  CHECK(giver.waiting());
  giver.receive(1_rank, Admission{1, Stage::kAnswer, {}});
  const auto refused = giver.settle(0, same = own);
  CHECK(refused.moves.empty());
  CHECK(refused.gone.empty());
  CHECK(refused.messages.empty());
  const auto again = giver.ask(std::vector<Move>{{0_sub, 1_rank}}, own);
  CHECK(step_of(again[0]).round == 3);
  giver.receive(2_rank, Admission{2, Stage::kAnswer, {{2_sub, 10}}});
  CHECK(giver.settle(0, same = own).moves == std::vector<Move>{{2_sub, 2_rank}});
  CHECK(giver.waiting());
}
