#pragma once

#include <algorithm>
#include <vector>

#include "driftmesh/ids.hpp"

namespace driftmesh::balancer {

/// A few ranks with which each one compares its load besides those that it touches: half of the way around the ring of
/// all ranks, an eighth, and so on down to one step. Each is a partner of its partners. Over them work crosses a whole
/// cluster in a few steps, also if ranks of one speed are numbered in a row and lie side by side.
[[nodiscard]] inline std::vector<Rank> distant_partners(Rank self, std::int32_t ranks) {
  std::vector<Rank> partners;
  constexpr std::int32_t kRatio = 4;
  for (std::int32_t distance = ranks / 2; distance > 0;
       distance = distance > 1 ? (distance + kRatio - 1) / kRatio : 0) {
    partners.push_back(Rank{(to_int(self) + distance) % ranks});
    partners.push_back(Rank{(to_int(self) + ranks - distance) % ranks});
  }
  std::ranges::sort(partners);
  partners.erase(std::unique(partners.begin(), partners.end()), partners.end());
  return partners;
}

}  // namespace driftmesh::balancer
