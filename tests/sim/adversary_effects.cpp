#include "sim/adversary_effects.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace driftmesh::sim {
namespace {

struct Counter {
  std::int64_t AdversaryEffects::*value;
  const char* what;
};

constexpr Counter kSums[] = {{&AdversaryEffects::by_chance, "moved by chance"},
                             {&AdversaryEffects::returns, "returns at once"},
                             {&AdversaryEffects::rotations, "rotations of all work"},
                             {&AdversaryEffects::behind_token, "moved behind the token"},
                             {&AdversaryEffects::by_policy, "moved by policies"},
                             {&AdversaryEffects::hand_offs_ahead, "hand-offs ahead of SPLITs"},
                             {&AdversaryEffects::splits_ahead, "groups of SPLITs ahead of hand-offs"},
                             {&AdversaryEffects::late_locations, "locations after the end of work"},
                             {&AdversaryEffects::repeated_locations, "repeated locations"},
                             {&AdversaryEffects::outdated_locations, "outdated locations"},
                             {&AdversaryEffects::late_plans, "moves planned too late"},
                             {&AdversaryEffects::questions, "questions for memory"},
                             {&AdversaryEffects::answers, "answers"},
                             {&AdversaryEffects::starved, "steps withheld"}};

}  // namespace

AdversaryEffects& AdversaryEffects::operator+=(const AdversaryEffects& other) {
  for (const Counter& counter : kSums) this->*counter.value += other.*counter.value;
  most_hops = std::max(most_hops, other.most_hops);
  return *this;
}

std::string words_of(const AdversaryEffects& effects) {
  std::string text;
  for (const Counter& counter : kSums) text += fmt::format("{} {}, ", effects.*counter.value, counter.what);
  return text + fmt::format("{} hops at most", effects.most_hops);
}

}  // namespace driftmesh::sim
