#include "sim/deeds.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace driftmesh::sim {
namespace {

struct Counter {
  std::int64_t Deeds::*value;
  const char* what;
};

constexpr Counter kSums[] = {{&Deeds::by_chance, "moved by chance"},
                             {&Deeds::returns, "returns at once"},
                             {&Deeds::rotations, "rotations of all work"},
                             {&Deeds::behind_token, "moved behind the token"},
                             {&Deeds::by_policy, "moved by policies"},
                             {&Deeds::hand_offs_ahead, "hand-offs ahead of SPLITs"},
                             {&Deeds::splits_ahead, "groups of SPLITs ahead of hand-offs"},
                             {&Deeds::late_locations, "locations after all work"},
                             {&Deeds::repeated_locations, "locations told again"},
                             {&Deeds::outdated_locations, "locations out of date"},
                             {&Deeds::late_plans, "moves planned too late"},
                             {&Deeds::starved, "steps withheld"}};

}  // namespace

Deeds& Deeds::operator+=(const Deeds& other) {
  for (const Counter& counter : kSums) this->*counter.value += other.*counter.value;
  most_hops = std::max(most_hops, other.most_hops);
  return *this;
}

std::string words_of(const Deeds& deeds) {
  std::string text;
  for (const Counter& counter : kSums) text += fmt::format("{} {}, ", deeds.*counter.value, counter.what);
  return text + fmt::format("{} hops at most", deeds.most_hops);
}

}  // namespace driftmesh::sim
