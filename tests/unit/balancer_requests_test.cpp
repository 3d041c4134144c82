// Work stealing: requests for work, and their answers.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "controller_fixture.hpp"

using namespace driftmesh;
using namespace driftmesh::balancer;
using namespace driftmesh::testing;

namespace {

/// A broker of three ranks to which rank 2 has told what it has, and rank 1 as well before it asked for work.
Controller asked_broker(const Layout& layout, const balancer::LoadNews& victim, const balancer::LoadNews& thief) {
  Controller broker = controller_of(0_rank, layout, "stealing");
  broker.receive(2_rank, victim, 1);
  broker.receive(1_rank, thief, 1);
  broker.receive(1_rank, balancer::WorkRequest{1_rank, 1, thief.remaining, thief.speed, 0}, 1);
  return broker;
}

/// What the broker passes on or asks for on behalf of rank 1.
std::vector<balancer::WorkRequest> requests_for_thief(const Decision& decision) {
  std::vector<balancer::WorkRequest> found;
  for (const auto& [to, request] : sent<balancer::WorkRequest>(decision))
    if (request.thief == 1_rank) found.push_back(request);
  return found;
}

}  // namespace

TEST_CASE("a rank asks for work when it begins its last subdomain, however long that takes, or a little earlier") {
  const Layout layout = grid_layout(12, 1, 3);
  const auto asks = [&](const Loads& own) {
    Controller c = controller_of(1_rank, layout, "stealing");
    return !sent<balancer::WorkRequest>(c.think(0, own, 1000)).empty();
  };
  CHECK(asks(loads_of(4, 4, 1e6)));
  CHECK(!asks(loads_of(4, 5, 1000)));  // a second each
  CHECK(asks(loads_of(4, 5, 5)));
  // What is left in a finished subdomain whose neighbors have split its borders is no work to rely on.
  CHECK(asks({{4_sub, 0, 1000, 40}, {5_sub, 0, 100, 40}}));
  CHECK(!asks({{4_sub, 0, 1000, 40}, {5_sub, 0, 400, 40}}));
}

TEST_CASE("a rank that runs low sends a request and waits for the answer") {
  const Layout layout = grid_layout(12, 1, 3);
  Controller broker = controller_of(0_rank, layout, "stealing"), thief = controller_of(1_rank, layout, "stealing"),
             victim = controller_of(2_rank, layout, "stealing");
  broker.receive(2_rank, balancer::LoadNews{1, 4000, 3000, 100}, 1);
  CHECK(broker.think(1, loads_of(0, 1, 1000), 1000).moves.empty());

  const auto request = sent<balancer::WorkRequest>(thief.think(1, loads_of(4, 4, 10), 300));
  REQUIRE(request.size() == 1);
  CHECK(request[0].first == 0_rank);
  CHECK(thief.waiting());

  broker.receive(1_rank, request[0].second, 1);
  CHECK(broker.waiting());
  const auto passed_on = sent<balancer::WorkRequest>(broker.think(1, loads_of(0, 1, 1000), 1000));
  CHECK(!broker.waiting());
  REQUIRE(passed_on.size() == 1);
  CHECK(passed_on[0].first == 2_rank);

  victim.receive(0_rank, passed_on[0].second, 1);
  const Decision gift = victim.think(1, loads_of(8, 11, 1000), 100);
  const auto answer = sent<balancer::WorkAnswer>(gift);
  REQUIRE(answer.size() == 1);
  CHECK(answer[0].first == 1_rank);
  CHECK(gift.moves.size() == 3);
  for (const Move& move : gift.moves) CHECK(move.destination == 1_rank);

  thief.receive(2_rank, answer[0].second, 1);
  CHECK(!thief.waiting());
  CHECK(sent<balancer::WorkRequest>(thief.think(1.5, loads_of(4, 4, 5), 300)).empty());  // there is some on its way
}

TEST_CASE("a rank asks again when all promised subdomains have arrived, even if they were finished at once") {
  const Layout layout = grid_layout(12, 1, 3);
  for (const bool answer_first : {true, false}) {
    CAPTURE(answer_first);
    Controller thief = controller_of(1_rank, layout, "stealing");
    const auto request = sent<balancer::WorkRequest>(thief.think(1, loads_of(4, 4, 10), 300));
    REQUIRE(request.size() == 1);
    const balancer::WorkAnswer answer{request[0].second.round, {{8_sub, 1_rank}, {9_sub, 1_rank}}};
    if (answer_first) thief.receive(2_rank, answer, 1);
    thief.arrived(8_sub, 1);
    CHECK(sent<balancer::WorkRequest>(thief.think(1.01, {}, 300)).empty());
    thief.arrived(9_sub, 1);
    if (!answer_first) thief.receive(2_rank, answer, 1);
    CHECK(sent<balancer::WorkRequest>(thief.think(1.02, {}, 300)).size() == 1);
  }
}

TEST_CASE("a refused rank stops asking and is served later") {
  const Layout layout = grid_layout(12, 1, 2);
  Controller broker = controller_of(0_rank, layout, "stealing"), thief = controller_of(1_rank, layout, "stealing");
  const auto request = sent<balancer::WorkRequest>(thief.think(1, {}, 300));
  REQUIRE(request.size() == 1);
  broker.receive(1_rank, balancer::LoadNews{1, 0, 0, 300}, 1);
  broker.receive(1_rank, request[0].second, 1);
  const auto refusal = sent<balancer::WorkAnswer>(broker.think(1, {}, 1000));
  REQUIRE(refusal.size() == 1);
  CHECK(refusal[0].second.moves.empty());
  thief.receive(0_rank, refusal[0].second, 1);
  CHECK(!thief.waiting());
  for (int i = 0; i < 100; ++i) CHECK(sent<balancer::WorkRequest>(thief.think(2 + i, {}, 300)).empty());

  // SPLITs have created work at the broker.
  CHECK(broker.think(200, loads_of(0, 4, 1000), 1000).moves.empty());
  const Decision late = broker.think(200.1, loads_of(0, 4, 1000), 1000);
  CHECK(!late.moves.empty());
  CHECK(sent<balancer::WorkAnswer>(late).size() == 1);
}

TEST_CASE("a rank that was refused with some work left is not taken for idle") {
  const Layout layout = grid_layout(12, 1, 3);
  Controller broker = asked_broker(layout, {1, 0, 0, 300}, {1, 25, 20, 300});
  CHECK(sent<balancer::WorkAnswer>(broker.think(1, {}, 300)).size() == 1);  // nobody has any
  broker.receive(2_rank, balancer::LoadNews{2, 3000, 2000, 300}, 1.01);
  const auto of_refused = requests_for_thief(broker.think(1.01, {}, 300));
  REQUIRE(!of_refused.empty());
  CHECK(of_refused[0].remaining > 0);
}

TEST_CASE("the broker refuses at once where less could be saved than a move must save") {
  const Layout layout = grid_layout(12, 1, 3);
  // The broker is idle, too: rank 1 would get a third of what rank 2 has.
  const auto passes_on = [&](double work) {
    const Decision decision = asked_broker(layout, {1, work, work, 1000}, {1, 0, 0, 1000}).think(1, {}, 1000);
    const bool passed = !requests_for_thief(decision).empty();
    CHECK(passed == sent<balancer::WorkAnswer>(decision).empty());
    return passed;
  };
  const double required = balancer::Worth{}.seconds;
  CHECK(!passes_on(2.9 * required * 1000));
  CHECK(passes_on(3.1 * required * 1000));
}

TEST_CASE("the broker tells until when work is worth giving, once all have told their speeds") {
  const Layout layout = grid_layout(12, 1, 3);
  const auto request_passed_on = [&](bool all, double thief_has) {
    Controller broker = controller_of(0_rank, layout, "stealing");
    CHECK(broker.think(1, {}, 2000).moves.empty());  // it tells itself its speed
    broker.receive(2_rank, balancer::LoadNews{1, 6000, 5000, 1000}, 1);
    if (all) broker.receive(1_rank, balancer::LoadNews{1, thief_has, 0, 1000}, 1);
    broker.receive(1_rank, balancer::WorkRequest{1_rank, 1, thief_has, 1000, 0}, 1);
    return requests_for_thief(broker.think(1, {}, 2000));
  };
  const auto known = request_passed_on(true, 0);
  REQUIRE(known.size() == 1);
  CHECK(known[0].horizon == doctest::Approx(1.25 * 6000 / 4000));
  const auto unknown = request_passed_on(false, 0);
  REQUIRE(unknown.size() == 1);
  CHECK(unknown[0].horizon == balancer::kNoHorizon);
  // A rank that has more than all have on average needs none.
  CHECK(request_passed_on(true, 4000).empty());
}

TEST_CASE("a giver keeps what the other rank would begin too late") {
  const Layout layout = grid_layout(40, 1, 2);
  const auto given = [&](double horizon) {
    Controller giver = controller_of(1_rank, layout, "stealing");
    giver.receive(0_rank, balancer::WorkRequest{0_rank, 1, 500, 1000, 0, 0, balancer::kAmpleMemory, horizon}, 1);
    return giver.think(1, loads_of(20, 39, 1000), 1000).moves.size();
  };
  CHECK(given(balancer::kNoHorizon) == 10);
  CHECK(given(4) == 4);  // begun after 0.5, 1.5, 2.5 and 3.5 seconds
  CHECK(given(0.4) == 0);
}

TEST_CASE("a giver tells the broker what it has left, even if that is little less than was to be expected") {
  const auto news = [](bool asked) {
    Controller giver = controller_of(1_rank, grid_layout(40, 1, 2), "stealing");
    REQUIRE(sent<balancer::LoadNews>(giver.think(1, loads_of(20, 39, 1000), 1000)).size() == 1);
    // For a tenth of a second it has worked as told. The other rank begins no more than one subdomain until the
    // horizon.
    if (asked) giver.receive(0_rank, balancer::WorkRequest{0_rank, 1, 500, 1000, 0, 0, kAmpleMemory, 0.6}, 1.1);
    Loads own = loads_of(20, 39, 1000);
    own[0].remaining = 900;
    const Decision decision = giver.think(1.1, own, 1000);
    CHECK(decision.moves.size() == (asked ? 1 : 0));
    return sent<balancer::LoadNews>(decision);
  };
  CHECK(news(false).empty());
  const auto told = news(true);
  REQUIRE(told.size() == 1);
  CHECK(told[0].first == 0_rank);
  CHECK(told[0].second.remaining == 18'900);
}

TEST_CASE("a rank that turns out to be slow gives work to those that were refused") {
  const Layout layout = grid_layout(12, 1, 3);
  Controller broker = controller_of(0_rank, layout, "stealing");
  broker.receive(1_rank, balancer::LoadNews{1, 0, 0, 1e6}, 0.5);
  broker.receive(1_rank, balancer::WorkRequest{1_rank, 1, 0, 1e6, 0}, 1);
  CHECK(sent<balancer::WorkAnswer>(broker.think(1, {}, 1e6)).size() == 1);  // at that speed all must be done
  double left = 0;
  for (const SubdomainId s : ids_of(layout.subdomains))
    if (layout[s].owner == 2_rank) left += layout[s].predicted;
  broker.receive(2_rank, balancer::LoadNews{1, left / 2, left / 4, left / 2}, 1.1);
  CHECK(!requests_for_thief(broker.think(1.1, {}, 1e6)).empty());
}

TEST_CASE("a rank that was refused with some work left is looked at again when that is done") {
  const Layout layout = grid_layout(12, 1, 3);
  Controller broker = asked_broker(layout, {1, 2000, 1900, 1000}, {1, 2000, 0, 1000});
  CHECK(sent<balancer::WorkAnswer>(broker.think(1, {}, 1000)).size() == 1);  // both have as much
  broker.receive(1_rank, balancer::LoadNews{2, 1500, 0, 1000}, 1.1);         // still its last subdomain
  CHECK(sent<balancer::WorkRequest>(broker.think(1.1, {}, 1000)).empty());
  broker.receive(1_rank, balancer::LoadNews{3, 0, 0, 1000}, 1.2);  // it had less work than forecast
  CHECK(!requests_for_thief(broker.think(1.2, {}, 1000)).empty());
}

TEST_CASE("the broker knows the memory of a rank whose request came before its first report") {
  Layout layout = grid_layout(12, 1, 3);
  for (Layout::Subdomain& s : layout.subdomains)
    if (s.owner == 1_rank) s.owner = 0_rank;
  Controller broker = controller_of(0_rank, layout, "stealing");
  broker.receive(2_rank, balancer::LoadNews{1, 0, 0, 300}, 1);
  broker.receive(1_rank, balancer::WorkRequest{.thief = 1_rank, .round = 1, .speed = 300, .free_memory = 500}, 1);
  CHECK(sent<balancer::WorkAnswer>(broker.think(1, {}, 300)).size() == 1);  // nobody has any
  broker.receive(2_rank, balancer::LoadNews{2, 3000, 2000, 300}, 1.01);
  const auto of_refused = requests_for_thief(broker.think(1.01, {}, 300));
  REQUIRE(!of_refused.empty());
  CHECK(of_refused[0].free_memory == 500);
}

TEST_CASE("a rank on whose behalf the broker asked in vain asks again by itself") {
  const Layout layout = grid_layout(12, 1, 3);
  Controller thief = controller_of(1_rank, layout, "stealing");
  REQUIRE(sent<balancer::WorkRequest>(thief.think(1, {}, 300)).size() == 1);
  thief.receive(0_rank, balancer::WorkAnswer{1, {}}, 1);
  CHECK(sent<balancer::WorkRequest>(thief.think(1.1, {}, 300)).empty());
  thief.receive(2_rank, balancer::WorkAnswer{0, {}}, 1.2);
  CHECK(sent<balancer::WorkRequest>(thief.think(1.2, {}, 300)).size() == 1);
}

TEST_CASE("a rank that givers refused often tries once more when it is out of work") {
  const Layout layout = grid_layout(12, 1, 3);
  Controller thief = controller_of(1_rank, layout, "stealing");
  const auto last = loads_of(4, 4, 1000);
  int asked = 0;
  double now = 1;
  const auto ask_and_be_refused = [&](std::span<const ReportedLoad> own) {
    for (int i = 0; i < 20; ++i)
      for (const auto& request : sent<balancer::WorkRequest>(thief.think(now += 0.1, own, 300))) {
        ++asked;
        thief.receive(2_rank, balancer::WorkAnswer{request.second.round, {}}, now);
      }
  };
  ask_and_be_refused(last);
  const int with_work = asked;
  CHECK(with_work == balancer::ControllerOptions{}.refusals);
  ask_and_be_refused({});
  CHECK(asked == with_work + 1);
}

TEST_CASE("requests are numbered, and only the answer to the last one counts") {
  Controller thief = controller_of(1_rank, grid_layout(12, 1, 3), "stealing");
  const auto first = sent<balancer::WorkRequest>(thief.think(1, {}, 300));
  REQUIRE(first.size() == 1);
  CHECK(first[0].second.round == 1);
  thief.receive(2_rank, balancer::WorkAnswer{1, {}}, 1);
  const auto second = sent<balancer::WorkRequest>(thief.think(2, {}, 300));
  REQUIRE(second.size() == 1);
  CHECK(second[0].second.round == 2);
  thief.receive(2_rank, balancer::WorkAnswer{1, {}}, 2);
  CHECK(thief.waiting());
  thief.receive(2_rank, balancer::WorkAnswer{2, {}}, 2);
  CHECK(!thief.waiting());
}

TEST_CASE("a gift ends a row of refusals, and what was promised is not waited for without end") {
  ControllerOptions options;
  options.refusals = 2;
  Controller thief(1_rank, std::make_shared<Layout>(grid_layout(12, 1, 3)), make_policy("stealing"), options, 0);
  double now = 1;
  const auto asks = [&] {
    const auto requests = sent<balancer::WorkRequest>(thief.think(now += 0.1, loads_of(4, 4, 1000), 300));
    return requests.empty() ? 0 : requests[0].second.round;
  };
  const auto refuse = [&](std::uint32_t round) { thief.receive(2_rank, balancer::WorkAnswer{round, {}}, now); };
  refuse(asks());
  thief.receive(2_rank, balancer::WorkAnswer{asks(), {{8_sub, 1_rank}}}, now);
  CHECK(asks() == 0);
  thief.arrived(8_sub, 1);
  refuse(asks());
  const auto last = asks();
  CHECK(last == 4);
  thief.receive(2_rank, balancer::WorkAnswer{last, {{9_sub, 1_rank}}}, now);
  CHECK(asks() == 0);
  now += options.interval;
  asks();
  CHECK(thief.waiting());  // for the answer to another request
}

TEST_CASE("a giver gives nothing twice, and less where others will ask, too") {
  const Layout layout = grid_layout(40, 1, 4);
  const auto given = [&](std::uint32_t rivals, int thieves) {
    Controller giver = controller_of(3_rank, layout, "stealing");
    for (std::int32_t t = 0; t < thieves; ++t)
      giver.receive(0_rank, balancer::WorkRequest{.thief = Rank{t}, .round = 1, .speed = 1000, .rivals = rivals}, 1);
    std::vector<SubdomainId> subdomains;
    for (const Move& move : giver.think(1, loads_of(0, 19, 1000), 1000).moves) subdomains.push_back(move.subdomain);
    return subdomains;
  };
  CHECK(given(0, 1).size() == 10);
  CHECK(given(3, 1).size() == 4);
  auto twice = given(0, 2);
  CHECK(twice.size() == 15);
  std::ranges::sort(twice);
  CHECK(std::ranges::adjacent_find(twice) == twice.end());
}

TEST_CASE("a refused rank is served once, and not if it has come to work otherwise") {
  const Layout layout = grid_layout(12, 1, 3);
  Controller broker = asked_broker(layout, {1, 0, 0, 300}, {1, 0, 0, 300});
  CHECK(sent<balancer::WorkAnswer>(broker.think(1, {}, 300)).size() == 1);  // nobody has any
  SUBCASE("once") {
    broker.receive(2_rank, balancer::LoadNews{2, 3000, 2000, 300}, 1.01);
    CHECK(requests_for_thief(broker.think(1.01, {}, 300)).size() == 1);
    broker.receive(2_rank, balancer::LoadNews{3, 9000, 8000, 300}, 1.02);
    CHECK(requests_for_thief(broker.think(1.02, {}, 300)).empty());
  }
  SUBCASE("not with work") {
    broker.receive(1_rank, balancer::LoadNews{2, 2000, 1900, 300}, 1.01);
    broker.receive(2_rank, balancer::LoadNews{2, 90000, 80000, 300}, 1.01);
    CHECK(requests_for_thief(broker.think(1.01, {}, 300)).empty());
  }
}
