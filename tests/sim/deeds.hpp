#pragma once

#include <cstdint>
#include <string>

namespace driftmesh::sim {

/// What adversaries have really brought about, so that a test can see that its schedules were not idle ones.
struct Deeds {
  std::int64_t by_chance = 0;     ///< subdomains moved
  std::int64_t returns = 0;       ///< of one subdomain to the rank that it had just come from
  std::int64_t rotations = 0;     ///< all that a rank had to do went to the next rank before the rank polled
  std::int64_t behind_token = 0;  ///< work given to a rank that the token had visited, by the one that held it
  std::int64_t by_policy = 0;     ///< subdomains moved because a balancer had decided so

  std::int64_t hand_offs_ahead = 0;     ///< came before SPLITs for the same subdomain that were sent earlier
  std::int64_t splits_ahead = 0;        ///< came somewhere while the subdomain they are for was under way
  std::int64_t late_locations = 0;      ///< location updates that came when all work was over
  std::int64_t repeated_locations = 0;  ///< ... that had come to the same rank before
  std::int64_t outdated_locations = 0;  ///< ... that said where a subdomain had been, not where it was by then
  std::int64_t late_plans = 0;          ///< moves planned of subdomains that had left when the plan came
  std::int64_t starved = 0;             ///< steps that a rank was not given
  std::int64_t most_hops = 0;           ///< of a group of SPLITs

  Deeds& operator+=(const Deeds& other);
};

/// "12 moved by chance, 30 returns, ..."
[[nodiscard]] std::string words_of(const Deeds& deeds);

}  // namespace driftmesh::sim
