#pragma once

#include <doctest/doctest.h>

#include <random>
#include <string>
#include <utility>
#include <vector>

#include "balancer/council.hpp"
#include "support/load_snapshots.hpp"

namespace driftmesh::testing {

/// What each rank of a snapshot contributes to a council. With `random`, some of its subdomains have just arrived.
inline std::vector<balancer::Contribution> contributions_of(const LoadSnapshot& snapshot,
                                                            std::mt19937_64* random = nullptr) {
  std::vector<balancer::Contribution> all;
  for (const Rank r : ids_of(snapshot.ranks)) all.push_back({r, snapshot.ranks[r], {}, {}});
  for (const balancer::SubdomainLoad& s : snapshot.subdomains) {
    balancer::Contribution& owner = all[to_index(s.owner)];
    owner.own.push_back(s);
    if (random && (*random)() % 5 == 0) owner.settled.push_back(s.id);
  }
  return all;
}

/// Of all ranks.
inline std::vector<balancer::Move> all_moves(const std::vector<balancer::Council::Decision>& decisions) {
  std::vector<balancer::Move> moves;
  for (const auto& d : decisions) moves.insert(moves.end(), d.moves.begin(), d.moves.end());
  return moves;
}

/// The problem of the decisions of a round, or "": each rank must move only subdomains that it owns and that have not
/// just arrived, each once and to another rank; all ranks must agree; and the states they expect must be those that the
/// moves lead to.
inline std::string problem_of(const LoadSnapshot& snapshot, const std::vector<balancer::Contribution>& contributions,
                              const std::vector<balancer::Council::Decision>& decisions) {
  IdVector<Rank, double> work;
  IdVector<Rank, std::int32_t> coming(decisions.size());
  for (const balancer::RankLoad& state : snapshot.ranks) work.push_back(state.remaining);
  bool any = false;
  for (const Rank r : ids_of(coming)) {
    SubdomainId last = kNoSubdomain;
    for (const balancer::Move& move : decisions[to_index(r)].moves) {
      const balancer::SubdomainLoad* const s = balancer::find(snapshot, move.subdomain);
      const auto& settled = contributions[to_index(r)].settled;
      if (!s || s->owner != r) return "a rank moves what it does not own";
      if (move.destination == s->owner || !work.has(move.destination)) return "a move to nowhere";
      if (move.subdomain <= last) return "moves are not in order, or one is listed twice";
      if (std::binary_search(settled.begin(), settled.end(), move.subdomain))
        return "a subdomain that just arrived moves on";
      last = move.subdomain;
      work[r] -= s->remaining;
      work[move.destination] += s->remaining;
      ++coming[move.destination];
      any = true;
    }
  }
  for (const Rank r : ids_of(coming)) {
    const balancer::Council::Decision& decision = decisions[to_index(r)];
    if (decision.any_moves != any) return "a rank is wrong about whether anything moves";
    if (decision.coming.count != coming[r]) return "a rank waits for more or less than arrives";
    for (const Rank i : ids_of(work))
      if (std::abs(decision.states[i].remaining - work[i]) > 1e-9 * (1 + std::abs(work[i])))
        return "the planned states are not those that the moves lead to";
  }
  return {};
}

/// Checks rounds with all of Zoltan's methods and approaches from this layout, and from one where the last rank has
/// all: plans are valid and end balanced. `hold(method, approach, snapshot, contributions)` returns the decisions.
template <class Hold>
void check_balanced(const balancer::Layout& layout, const IdVector<Rank, double>& speeds, const Hold& hold) {
  for (const bool lopsided : {false, true})
    for (const std::string method : {"rcb", "hsfc", "graph", "hypergraph"})
      for (const std::string approach : {"repartition", "partition", "refine"}) {
        CAPTURE(lopsided);
        CAPTURE(method);
        CAPTURE(approach);
        balancer::Layout start = layout;
        for (auto& s : start.subdomains)
          if (lopsided) s.owner = Rank{layout.ranks - 1};
        const LoadSnapshot snapshot = initial_snapshot(std::move(start), speeds);
        const auto contributions = contributions_of(snapshot);
        const auto decisions = hold(method, approach, snapshot, contributions);
        REQUIRE(problem_of(snapshot, contributions, decisions) == "");
        CHECK(time_with(snapshot, all_moves(decisions)) < 1.05 * ideal_time(snapshot));
        if (snapshot.ranks.size() > 1) CHECK(decisions[0].any_moves);
      }
}

}  // namespace driftmesh::testing
