#pragma once

#include <algorithm>
#include <map>
#include <random>
#include <vector>

#include "driftmesh/ids.hpp"
#include "runtime/subdomain_loop.hpp"
#include "sim/adversary_effects.hpp"
#include "sim/scenario.hpp"

namespace driftmesh::sim {

/// Hands subdomains over between two steps of a rank, in ways that a protocol may not expect.
class Mover {
 public:
  explicit Mover(const Scenario& scenario)
      : scenario_(scenario), random_(scenario.seed * 31 + 7), left_(scenario.most_moves) {
    ball_ = static_cast<SubdomainId>(below(static_cast<std::uint64_t>(scenario.subdomains)));
    if (scenario.mover == "ping-pong" || scenario.mover == "rotation") left_ = 10 * left_;
  }

  /// Any rank, at random.
  Rank any_rank() { return static_cast<Rank>(below(static_cast<std::uint64_t>(scenario_.ranks))); }

  /// Called before a rank polls.
  void before_step(SubdomainLoop& loop, Rank rank) {
    if (left_ <= 0 || scenario_.ranks == 1) return;
    if (scenario_.mover == "ping-pong")
      play(loop, rank);
    else if (scenario_.mover == "rotation")
      rotate(loop, rank);
    else if (scenario_.mover == "behind-token")
      follow_token(loop, rank);
    else if (chance(scenario_.move_chance))
      move_any(loop);
  }

  [[nodiscard]] const AdversaryEffects& effects() const { return effects_; }

 private:
  bool hand_over(SubdomainLoop& loop, SubdomainId s, Rank to) {
    const bool moved = loop.hand_over(s, to);
    if (moved) --left_;
    return moved;
  }

  [[nodiscard]] static std::vector<SubdomainId> active(const SubdomainLoop& loop) {
    std::vector<SubdomainId> result;
    for (const auto& [id, subdomain] : loop.subdomains())
      if (subdomain.active()) result.push_back(id);
    return result;
  }

  void move_any(SubdomainLoop& loop) {
    const auto all = active(loop);
    if (!all.empty() && hand_over(loop, all[below(all.size())], any_rank())) ++effects_.by_chance;
  }

  // A subdomain goes back and forth as long as it has work.
  void play(SubdomainLoop& loop, Rank rank) {
    const auto from = came_from_.find(rank);
    const Rank to = from == came_from_.end() ? next_in_ring(rank, scenario_.ranks) : from->second;
    if (!hand_over(loop, ball_, to)) return;
    if (from != came_from_.end()) ++effects_.returns;
    came_from_[to] = rank;
  }

  void rotate(SubdomainLoop& loop, Rank rank) {
    const auto all = active(loop);
    for (const SubdomainId s : all) hand_over(loop, s, next_in_ring(rank, scenario_.ranks));
    if (!all.empty()) ++effects_.rotations;
  }

  // The case that Safra's colors are for: another rank may have answered the probe that this one holds up.
  void follow_token(SubdomainLoop& loop, Rank rank) {
    if (!loop.protocol().termination().has_token()) return;
    const auto all = active(loop);
    if (all.empty()) return;
    const Rank to = any_rank();
    if (to != rank && hand_over(loop, all[below(all.size())], to)) ++effects_.behind_token;
  }

  std::uint64_t below(std::uint64_t n) { return random_() % n; }
  bool chance(double probability) { return static_cast<double>(random_() >> 11) * 0x1p-53 < probability; }

  const Scenario& scenario_;
  std::mt19937_64 random_;
  std::int64_t left_;  // moves
  SubdomainId ball_;
  std::map<Rank, Rank> came_from_;  // the ball, to each rank when it last did
  AdversaryEffects effects_;
};

}  // namespace driftmesh::sim
