#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "balancer/load_snapshot.hpp"
#include "balancer/move_cost.hpp"
#include "balancer/policy.hpp"

/// A plan that all ranks make together (Placement::kCollective). Nobody knows all subdomains: each rank has parts made
/// of its own, and tells the others how much of what part it holds, and single subdomains that would even out the rest.
/// From what all have told, which is the same everywhere, each draws the same conclusions. What is told is as much as
/// there are pairs of a rank and a part that share subdomains, far less than there are subdomains.
///
/// The steps are pure functions; how what is told reaches everybody is the matter of a Council.
namespace driftmesh::balancer {

/// What a rank brings: what it has to do.
struct Contribution {
  Rank rank = 0;
  RankState state;                   ///< its speed; its work, also what is still on its way to it
  std::vector<SubdomainState> own;   ///< that are here and not finished, in ascending order of their numbers
  std::vector<SubdomainId> settled;  ///< of these, ascending: they have come lately, and stay
};

/// The same for a policy: what a rank owns, and the states of all.
[[nodiscard]] LoadSnapshot own_snapshot(const Contribution& contribution, std::shared_ptr<const Layout> layout,
                                        std::vector<RankState> states);

/// The subdomains of one part that one rank holds and could give away.
struct Bundle {
  Rank holder = 0;
  Rank part = 0;
  double work = 0;
  std::uint64_t bytes = 0;
  std::int32_t count = 0;  ///< of subdomains
};

/// What a rank holds of which part, given the part of each of its subdomains. What is not worth its packing is left
/// out.
[[nodiscard]] std::vector<Bundle> bundles_of(const Contribution& contribution, std::span<const Rank> parts,
                                             const MoveCost& cost);

/// Which rank takes which part, and what all will have to do then.
struct DealtParts {
  std::vector<Rank> rank_of;      ///< each part
  std::vector<RankState> states;  ///< of all ranks afterwards
};

/// Parts go to ranks as remap_parts does it.
[[nodiscard]] DealtParts deal_parts(const std::vector<RankState>& states, std::span<const Bundle> bundles,
                                    double tolerance);

/// A single subdomain that could go elsewhere than its part.
struct Offer {
  Rank holder = 0;
  Rank part = 0;
  SubdomainState subdomain;  ///< its owner is the rank that takes its part
};

/// Subdomains of this rank that ranks with more than their share might do without, for each as much as it has too much,
/// if there is as much: those first that move most easily.
[[nodiscard]] std::vector<Offer> offers_of(const Contribution& contribution, std::span<const Rank> parts,
                                           const DealtParts& dealt, const MoveCost& cost, const Dealing& dealing);

/// What everybody concludes.
struct JointPlan {
  struct Flow {
    Rank from = 0, part = 0, to = 0;  ///< all that rank `from` holds of a part, but what it has offered, goes there
  };
  struct Coming {
    double work = 0;
    std::int32_t count = 0;  ///< of subdomains
  };
  std::vector<Flow> flows;        ///< by from and part
  std::vector<Move> moves;        ///< of subdomains that were offered, by their numbers
  std::vector<RankState> states;  ///< of all ranks when everything has arrived
  std::vector<Coming> coming;     ///< what goes to each rank
  [[nodiscard]] bool any_moves() const { return !flows.empty() || !moves.empty(); }
};

/// `offers` of all ranks are dealt as deal_surplus does it, and of what moves only what is worth it remains.
[[nodiscard]] JointPlan conclude(const std::vector<RankState>& states, std::span<const Bundle> bundles,
                                 std::span<const Offer> offers, const DealtParts& dealt, const Dealing& dealing,
                                 const MoveCost& cost, const Worth& worth);

/// What this rank is to hand over.
[[nodiscard]] std::vector<Move> moves_of(const Contribution& contribution, std::span<const Rank> parts,
                                         const std::vector<Offer>& own_offers, const JointPlan& plan,
                                         const MoveCost& cost);

}  // namespace driftmesh::balancer
