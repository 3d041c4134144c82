#include "sim/scenario.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <random>

#include "sim/domains.hpp"
#include "support/rules_over_tree.hpp"

namespace driftmesh::sim {
namespace {

const char* words_of(Mischief mischief) {
  switch (mischief) {
    case Mischief::kNone:
      break;
    case Mischief::kRacingHandOffs:
      return ", hand-offs and SPLITs race";
    case Mischief::kLateLocations:
      return ", locations known late";
    case Mischief::kStaleLocations:
      return ", stale locations";
    case Mischief::kLateAdvice:
      return ", late advice";
  }
  return "";
}

}  // namespace

const std::vector<std::string>& mover_names() {
  static const std::vector<std::string> kNames{"chance", "ping-pong", "rotation", "behind-token",
                                               "greedy", "diffusion", "stealing", "zoltan"};
  return kNames;
}

bool Scenario::balanced() const {
  return std::find(mover_names().begin() + 4, mover_names().end(), mover) != mover_names().end();
}

// Every random draw is made regardless of the choice, so that a choice changes nothing else.
Scenario Scenario::from_seed(std::uint64_t seed, const Choice& choice) {
  std::mt19937_64 random(seed * 0x9e3779b97f4a7c15u + 1);
  const auto one_of = [&](const auto& values) { return values[random() % values.size()]; };
  Scenario s;
  s.seed = seed;
  s.domain = choice.domain.value_or(one_of(domain_names()));
  s.ranks = choice.ranks.value_or(one_of(std::array<std::int32_t, 12>{1, 2, 2, 3, 3, 4, 5, 6, 8, 11, 13, 16}));
  s.subdomains = one_of(std::array{4, 7, 12});
  s.presplit = choice.presplit.value_or(random() % 3 == 0);
  s.aggregation = choice.aggregation.value_or(one_of(std::array<std::size_t, 5>{1, 2, 7, 30, 512}));
  s.slice = one_of(std::array<std::int64_t, 4>{3, 10, 30, 16384});
  s.order = one_of(std::array{WorkOrder::kGiven, WorkOrder::kLargest, WorkOrder::kBacklog});
  s.move_chance = one_of(std::array{0.0, 0.05, 0.3, 1.0});
  s.most_moves = one_of(std::array{5, 20, 60});
  s.sleep = random() % 3 == 0;
  s.adversary = protocol::Adversary::from_seed(seed);
  s.adversary.step_limit = 200'000;
  s.adversary.may_copy = [](Rank source, auto bytes) {
    return protocol::traffic_of(source, bytes) == protocol::Traffic::kDetection;
  };
  s.mover = one_of(mover_names());
  if (choice.mover) s.mover = *choice.mover;
  s.lopsided = random() % 4 == 0;
  s.mischief = one_of(std::array{Mischief::kNone, Mischief::kNone, Mischief::kRacingHandOffs, Mischief::kLateLocations,
                                 Mischief::kStaleLocations, Mischief::kLateAdvice});
  s.short_of_memory = seed % 5 == 0;
  s.arity = testing::arity_for(seed);
  s.crew = random() % 3 == 0 ? 1 + random() % 4 : 0;
  // With first-in-first-out order, a delayed message would block all behind it.
  if (s.mischief != Mischief::kNone && s.mischief != Mischief::kStaleLocations) s.adversary.fifo = false;
  return s;
}

std::string Scenario::describe() const {
  const protocol::Adversary& a = adversary;
  return fmt::format(
      "seed {}: {} in {} subdomains on {} ranks, presplit {}, {} SPLITs a message, slices of {}{}; {}moved by {}{}{}, "
      "{} "
      "times at most, by chance {} at each step; at most {} ranks below each; {}, delay {}{}{}{}{}",
      seed, domain, subdomains, ranks, presplit ? "on" : "off", aggregation, slice,
      sleep ? ", finished subdomains sleep" : "", crew > 0 ? fmt::format("crews of {}; ", crew) : "", mover,
      short_of_memory ? " within memory" : "", lopsided ? " from a single rank" : "", most_moves, move_chance, arity,
      a.fifo ? "in order" : "reordered", a.delay, a.starve ? ", a rank starved" : "",
      a.hold_one ? ", a message held back" : "", a.copy > 0 ? ", copies" : "", words_of(mischief));
}

}  // namespace driftmesh::sim
