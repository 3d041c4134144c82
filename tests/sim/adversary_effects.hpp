#pragma once

#include <cstdint>
#include <string>

namespace driftmesh::sim {

/// What an adversary really achieved, so that a test can check that its schedules were hard.
struct AdversaryEffects {
  std::int64_t by_chance = 0;     ///< subdomains moved
  std::int64_t returns = 0;       ///< a subdomain went back to the rank that it had just come from
  std::int64_t rotations = 0;     ///< a rank's whole work went to the next rank before the rank polled
  std::int64_t behind_token = 0;  ///< work given away by a rank that had not answered a probe
  std::int64_t by_policy = 0;     ///< subdomains moved by decision of a balancer

  std::int64_t hand_offs_ahead = 0;     ///< arrived before SPLITs for the same subdomain that were sent earlier
  std::int64_t splits_ahead = 0;        ///< arrived somewhere while their subdomain was under way
  std::int64_t late_locations = 0;      ///< location updates that arrived when all work was done
  std::int64_t repeated_locations = 0;  ///< ... that the same rank had received before
  std::int64_t outdated_locations = 0;  ///< ... that named a former location
  std::int64_t late_plans = 0;          ///< planned moves of subdomains that had left when the plan arrived
  std::int64_t questions = 0;           ///< questions to ranks that may be short of memory
  std::int64_t answers = 0;
  std::int64_t starved = 0;    ///< steps that a rank was denied
  std::int64_t most_hops = 0;  ///< hops of a group of SPLITs

  AdversaryEffects& operator+=(const AdversaryEffects& other);
};

/// "12 moved by chance, 30 returns, ..."
[[nodiscard]] std::string words_of(const AdversaryEffects& effects);

}  // namespace driftmesh::sim
