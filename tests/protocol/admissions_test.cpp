// Ranks that are short of memory: they are asked before work goes to them.
#include "balancer/admissions.hpp"

#include <doctest/doctest.h>

#include <array>
#include <tuple>

#include "balancer/snapshot/codec.hpp"
#include "balancer/snapshot/deliberation.hpp"
#include "property/cases.hpp"
#include "protocol/codec.hpp"
#include "protocol/transport_layer.hpp"
#include "support/adversarial_network.hpp"
#include "support/balanced_ranks.hpp"
#include "support/id_literals.hpp"

using namespace driftmesh;
using namespace driftmesh::balancer;
using driftmesh::testing::grid_layout;
using driftmesh::testing::Jobs;
using Stage = Admission::Stage;

namespace {

/// What ranks say to each other about admissions, seen from the network.
struct Conversation {
  struct Question {
    std::map<SubdomainId, double> guests;
    int answers = 0;
    std::map<SubdomainId, double> admitted, returned;
  };
  std::map<std::tuple<Rank, Rank, std::uint32_t>, Question> questions;  // by giver, receiver and round
  std::map<std::tuple<Rank, Rank, SubdomainId>, int> hand_offs;

  void sent(Rank from, Rank to, const Admission& step) {
    const bool by_receiver = step.stage == Stage::kAnswer;
    Question& question = questions[{by_receiver ? to : from, by_receiver ? from : to, step.round}];
    question.answers += by_receiver ? 1 : 0;
    auto& guests = step.stage == Stage::kAsk      ? question.guests
                   : step.stage == Stage::kAnswer ? question.admitted
                                                  : question.returned;
    for (const Admission::Guest& guest : step.guests) guests[guest.subdomain] = guest.triangles;
  }

  void handed_over(Rank from, Rank to, SubdomainId id) { ++hand_offs[{from, to, id}]; }

  // The first problem, or "".
  [[nodiscard]] std::string problem() const {
    auto came = hand_offs;
    for (const auto& [key, question] : questions) {
      if (question.answers != 1) return std::to_string(question.answers) + " answers to one question";
      for (const auto& [id, triangles] : question.admitted)
        if (!question.guests.contains(id))
          return "somebody else is admitted";
        else if (!question.returned.contains(id) && --came[{std::get<0>(key), std::get<1>(key), id}] < 0)
          return "what was admitted neither came nor was returned";
      for (const auto& [id, triangles] : question.returned)
        if (!question.admitted.contains(id)) return "what was not admitted is returned";
    }
    return "";
  }
};

class OverheardTransport final : public protocol::TransportLayer {
 public:
  OverheardTransport(protocol::Transport& inner, Conversation& conversation)
      : TransportLayer(inner), conversation_(conversation) {}
  void send(Rank destination, Bytes bytes) override {
    static constexpr protocol::WireLimits kLimits{.ranks = 100, .subdomains = 10000, .roots = 1};
    const protocol::Message message = protocol::decode(rank(), bytes, kLimits);
    if (const auto* const advice = std::get_if<protocol::Advice>(&message)) {
      const Message said = decode(rank(), *advice, kLimits);
      if (const auto* const step = std::get_if<Admission>(&said)) conversation_.sent(rank(), destination, *step);
    }
    if (const auto* const moved = std::get_if<protocol::HandOff>(&message))
      conversation_.handed_over(rank(), destination, moved->subdomain);
    TransportLayer::send(destination, std::move(bytes));
  }

 private:
  Conversation& conversation_;
};

/// The ranks of a network that is listened to.
template <class Network>
class Overheard {
 public:
  Overheard(Network& network, std::int32_t ranks) {
    for (const Rank r : first_ids<Rank>(ranks))
      transports_.push_back(std::make_unique<OverheardTransport>(network.transport(r), conversation_));
  }
  protocol::Transport& transport(Rank r) { return *transports_[r]; }
  [[nodiscard]] const Conversation& conversation() const { return conversation_; }

 private:
  Conversation conversation_;
  IdVector<Rank, std::unique_ptr<OverheardTransport>> transports_;
};

/// Jobs of unequal size that are as forecast, in the possession of a few ranks.
Jobs draw_jobs(Layout& layout, std::mt19937_64& random) {
  Jobs jobs;
  const std::int32_t givers = 1 + static_cast<std::int32_t>(random() % static_cast<std::uint64_t>(layout.ranks));
  for (auto& s : layout.subdomains) {
    s.predicted = static_cast<double>(200 + random() % 1800);
    s.owner = static_cast<Rank>(random() % static_cast<std::uint64_t>(givers));
    jobs.push_back({0, s.predicted, s.predicted});
  }
  return jobs;
}

/// Memory for what a rank has, and for some jobs more, or for any number.
IdVector<Rank, double> draw_memory(const Layout& layout, std::mt19937_64& random) {
  IdVector<Rank, double> memory(to_index(layout.ranks), 0);
  for (const auto& s : layout.subdomains) memory[s.owner] += s.predicted;
  for (double& m : memory) m = random() % 6 == 0 ? kAmpleMemory : m + static_cast<double>(random() % 8000);
  return memory;
}

ReportedLoad load(SubdomainId id, double remaining) {
  return {id, 0, remaining, 0};
}

/// The only message, which must be an admission.
Admission only(const std::vector<Outgoing>& messages) {
  REQUIRE(messages.size() == 1);
  return std::get<Admission>(messages.front().message);
}

/// What a rank that asked before is told to hand over, given what it has now.
Admissions::Settled told(Admissions& giver, const Admission& answer, std::vector<ReportedLoad> own) {
  giver.receive(1_rank, answer);
  return giver.settle(kAmpleMemory, own);
}

}  // namespace

TEST_CASE("what fits is admitted, and memory is set aside for it until it arrives or is returned") {
  Admissions receiver(1_rank);
  receiver.receive(0_rank, {1, Stage::kAsk, {{3_sub, 500}, {4_sub, 700}, {5_sub, 400}}});
  receiver.receive(2_rank, {1, Stage::kAsk, {{6_sub, 150}}});
  CHECK(receiver.pressing());
  std::vector<ReportedLoad> own;
  auto settled = receiver.settle(1000, own);
  REQUIRE(settled.messages.size() == 2);
  CHECK(std::get<Admission>(settled.messages[0].message) == Admission{1, Stage::kAnswer, {{3_sub, 500}, {5_sub, 400}}});
  CHECK(std::get<Admission>(settled.messages[1].message) == Admission{1, Stage::kAnswer, {}});
  CHECK(settled.refused);
  CHECK(settled.not_coming == std::vector{4_sub, 6_sub});
  CHECK(receiver.set_aside() == 900);
  CHECK_FALSE(receiver.waiting());
  receiver.arrived(3_sub);
  CHECK(receiver.set_aside() == 400);
  receiver.receive(0_rank, {7, Stage::kReturn, {{5_sub, 400}}});  // another question
  receiver.receive(2_rank, {1, Stage::kReturn, {{5_sub, 400}}});  // another giver
  CHECK(receiver.settle(1000, own).not_coming.empty());
  receiver.receive(0_rank, {1, Stage::kReturn, {{5_sub, 400}}});
  CHECK(receiver.settle(1000, own).not_coming == std::vector{5_sub});
  CHECK(receiver.set_aside() == 0);
}

TEST_CASE("a giver waits for the answer, and hands over what was admitted if it is still there and no larger") {
  const std::vector<ReportedLoad> own{load(1_sub, 100), load(2_sub, 200), load(3_sub, 300), load(4_sub, 400)};
  const std::vector<Move> moves{{2_sub, 1_rank}, {3_sub, 1_rank}, {4_sub, 1_rank}};
  const Admission all{1, Stage::kAnswer, {{2_sub, 200}, {3_sub, 300}, {4_sub, 400}}};
  Admissions giver(0_rank);
  CHECK(only(giver.ask(moves, own)) == Admission{1, Stage::kAsk, {{2_sub, 200}, {3_sub, 300}, {4_sub, 400}}});
  CHECK(giver.waiting());
  CHECK_FALSE(giver.pressing());
  auto seen = own;
  CHECK(giver.settle(kAmpleMemory, seen).moves.empty());
  CHECK(seen == std::vector{load(1_sub, 100)});

  SUBCASE("all of them") {
    const auto settled = told(giver, all, own);
    CHECK(settled.moves == moves);
    CHECK(settled.messages.empty());
  }
  SUBCASE("one has been finished, and one has grown") {
    const auto settled = told(giver, all, {load(1_sub, 100), load(2_sub, 200), load(4_sub, 500)});
    CHECK(settled.moves == std::vector<Move>{{2_sub, 1_rank}});
    REQUIRE(settled.messages.size() == 2);
    CHECK(std::get<Admission>(settled.messages[0].message) == Admission{1, Stage::kReturn, {{3_sub, 300}}});
    CHECK(std::get<Admission>(settled.messages[1].message) == Admission{1, Stage::kReturn, {{4_sub, 400}}});
  }
  SUBCASE("only one is admitted") {
    const auto settled = told(giver, {1, Stage::kAnswer, {{3_sub, 300}}}, own);
    CHECK(settled.moves == std::vector<Move>{{3_sub, 1_rank}});
    CHECK(settled.messages.empty());
  }
  SUBCASE("one cannot be handed over after all") {
    CHECK(told(giver, all, own).messages.empty());
    giver.stayed(3_sub);
    CHECK(giver.pressing());
    auto rest = own;
    CHECK(only(giver.settle(kAmpleMemory, rest).messages) == Admission{1, Stage::kReturn, {{3_sub, 300}}});
  }
  CHECK_FALSE(giver.waiting());
  CHECK(told(giver, all, own).moves.empty());  // an answer counts once
}

TEST_CASE("only a destination that may be short of memory is asked") {
  LoadSnapshot snapshot = testing::initial_snapshot(grid_layout(6, 1, 3), {1, 1, 1});
  const std::vector<Move> moves{{0_sub, 1_rank}, {1_sub, 1_rank}, {2_sub, 2_rank}};
  CHECK(short_of_memory(snapshot, moves).empty());
  snapshot.ranks[1_rank].free_memory = 2 * kUnawareGivers * memory_for(snapshot.subdomains.front());
  snapshot.ranks[2_rank].free_memory = snapshot.ranks[1_rank].free_memory;
  CHECK(short_of_memory(snapshot, moves).empty());
  CHECK(short_of_memory(snapshot, moves, {}, 3) == std::vector{1_rank});
  CHECK(short_of_memory(snapshot, moves, {{2_rank, 1}}) == std::vector<Rank>{});
  CHECK(short_of_memory(snapshot, moves, {{1_rank, 1}}) == std::vector{1_rank});
  snapshot.ranks[1_rank].free_memory -= 1;
  CHECK(short_of_memory(snapshot, moves) == std::vector{1_rank});
}

namespace {

const std::array<std::string, 4> kPolicies{"greedy", "diffusion", "stealing", "zoltan"};

/// What many runs with a policy did.
struct Tally {
  int runs = 0, moves = 0, questions = 0, refusals = 0, returned = 0, overfilled = 0;
  void print(const std::string& policy) const {
    std::printf("%-10s %6d moves, %5d questions, %5d refused in part, %5d returned, %3d of %d runs overfilled a rank\n",
                policy.c_str(), moves, questions, refusals, returned, overfilled, runs);
  }
};

/// A random layout with jobs and memory.
struct Case {
  explicit Case(std::mt19937_64& random)
      : layout(grid_layout(static_cast<int>(2 + random() % 9), static_cast<int>(1 + random() % 9),
                           static_cast<std::int32_t>(2 + random() % 8))),
        jobs(draw_jobs(layout, random)),
        memory(draw_memory(layout, random)) {}
  Layout layout;
  Jobs jobs;
  IdVector<Rank, double> memory;
};

template <class Network>
void run(Network& network, const Case& drawn, const std::string& policy, const Parameters::Values& parameters,
         const ControllerOptions& options, double triangle, Tally& tally) {
  constexpr double kWholeJobs = 1e9;  // what a rank has of a job is as exact as the forecast, then
  Overheard overheard(network, drawn.layout.ranks);
  testing::WorkingRanks workers(overheard, drawn.layout, drawn.jobs, policy, parameters, options,
                                {.slice = kWholeJobs, .triangle = triangle, .memory = drawn.memory});
  double most_over = 0;
  IdVector<Rank, protocol::RankStep> steps;
  for (const Rank r : ids_of(drawn.memory))
    steps.emplace_back([&, r] {
      const protocol::StepResult result = workers.steps()[r]();
      most_over = std::max(most_over, workers.occupied(r) - drawn.memory[r]);
      return result;
    });
  const testing::Outcome outcome = workers.outcome(network.run(steps).end);
  REQUIRE(outcome.complete);
  REQUIRE(overheard.conversation().problem() == "");
  ++tally.runs;
  tally.moves += outcome.moves;
  tally.overfilled += most_over > 0 ? 1 : 0;
  for (const auto& [key, question] : overheard.conversation().questions) {
    ++tally.questions;
    tally.refusals += question.admitted.size() < question.guests.size() ? 1 : 0;
    tally.returned += static_cast<int>(question.returned.size());
  }
}

}  // namespace

TEST_CASE("hardly ever a rank gets more than it has memory for") {
  std::map<std::string, Tally> tallies;
  const auto saw_all = [&] {
    return std::ranges::all_of(kPolicies, [&](const std::string& policy) {
      return tallies[policy].moves > 0 && tallies[policy].questions > 0;
    });
  };
  auto random = testing::seeded_generator("short of memory");
  for (std::int64_t i = 0; testing::more_cases(i, 300, saw_all()); ++i) {
    const std::uint64_t seed = random();
    CAPTURE(seed);
    std::mt19937_64 one(seed);
    const Case drawn(one);
    ControllerOptions options;
    options.cost.latency = std::pow(10, -static_cast<double>(one() % 4) - 2);
    protocol::VirtualCluster cluster;
    cluster.link = [latency = options.cost.latency](Rank, Rank) { return protocol::Link{latency, 1e9}; };
    while (cluster.speeds.size() < drawn.memory.size())
      cluster.speeds.push_back(std::exp(static_cast<double>(one() % 300) / 100) * 1e4 / reference_speed({}));
    for (const std::string& policy : kPolicies) {
      CAPTURE(policy);
      protocol::VirtualNetwork network(cluster);
      run(network, drawn, policy, {}, options, 1 / reference_speed({}), tallies[policy]);
    }
  }
  for (const auto& [policy, tally] : tallies) {
    tally.print(policy);
    CHECK(100 * tally.overfilled <= tally.runs);  // a report may just have become wrong
  }
  CHECK(saw_all());
}

// Where messages may take forever, what a rank once told of its memory may be ever so old.
TEST_CASE("on an adversarial network each question has one answer, and what is admitted comes or is returned") {
  const ControllerOptions options = testing::options_in_steps();
  std::map<std::string, Tally> tallies;
  const auto saw_all = [&] {
    return tallies["diffusion"].refusals > 0 && std::ranges::all_of(kPolicies, [&](const std::string& policy) {
             const Tally& tally = tallies[policy];
             return tally.moves > 0 && tally.questions > 0 && tally.returned > 0;
           });
  };
  auto random = testing::seeded_generator("admissions");
  for (std::int64_t i = 0; testing::more_cases(i, 400, saw_all()); ++i) {
    const std::uint64_t seed = random();
    CAPTURE(seed);
    std::mt19937_64 one(seed);
    const Case drawn(one);
    for (const std::string& policy : kPolicies) {
      CAPTURE(policy);
      protocol::AdversarialNetwork network(drawn.layout.ranks, protocol::Adversary::from_seed(seed));
      testing::TimedNetwork timed(network, drawn.layout.ranks);
      run(timed, drawn, policy, policy == "stealing" ? Parameters::Values{{"low-water", "1"}} : Parameters::Values{},
          options, 1e-3, tallies[policy]);
      REQUIRE(network.in_flight() == 0);
    }
  }
  for (const auto& [policy, tally] : tallies) {
    tally.print(policy);
    CHECK(50 * tally.overfilled <= tally.runs);
  }
  CHECK(saw_all());
}
