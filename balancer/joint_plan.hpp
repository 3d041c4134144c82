#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "balancer/move_cost.hpp"
#include "driftmesh/load_snapshot.hpp"
#include "driftmesh/policy.hpp"

/// A plan that all ranks make together (Placement::kCollective). Nobody knows all subdomains: each rank has parts made
/// of its own, and tells the others how much of what part it holds, and single subdomains that would even out the rest.
/// From what all have told, which is the same everywhere, each draws the same conclusions. What is told is as much as
/// there are pairs of a rank and a part that share subdomains, far less than there are subdomains.
///
/// What goes from one rank to another waits for its way once, and not once a subdomain as a leader reckons.
///
/// The steps are pure functions; how what is told reaches everybody is the matter of a Council.
namespace driftmesh::balancer {

/// What a rank brings: what it has to do.
struct Contribution {
  Rank rank{};
  RankLoad state;                    ///< its speed; its work, also what is still on its way to it
  std::vector<SubdomainLoad> own;    ///< that are here and not finished, in ascending order of their numbers
  std::vector<SubdomainId> settled;  ///< ascending: what has come lately, and stays
};

/// The same for a policy: what a rank owns, and the states of all.
[[nodiscard]] LoadSnapshot own_snapshot(const Contribution& contribution, std::shared_ptr<const Layout> layout,
                                        IdVector<Rank, RankLoad> states);

/// The subdomains of one part that one rank holds and could give away.
struct Bundle {
  Rank holder{};
  Part part{};
  double work = 0;
  std::uint64_t bytes = 0;
};

/// What a rank holds of which part, given the part of each of its subdomains. What is not worth its packing is left
/// out.
[[nodiscard]] std::vector<Bundle> bundles_of(const Contribution& contribution, std::span<const Part> parts,
                                             const MoveCost& cost);

/// Which rank takes which part, and what all will have to do then.
struct DealtParts {
  IdVector<Part, Rank> rank_of;     ///< each part
  IdVector<Rank, RankLoad> states;  ///< of all ranks afterward
};

/// Parts go to ranks as remap_parts does it.
[[nodiscard]] DealtParts deal_parts(const IdVector<Rank, RankLoad>& states, std::span<const Bundle> bundles,
                                    double tolerance);

/// A single subdomain that could go elsewhere than its part.
struct Offer {
  Rank holder{};
  Part part{};
  SubdomainLoad subdomain;  ///< its owner is the rank that takes its part
};

/// Subdomains of this rank that ranks with more than their share might do without, for each as much as it has too much,
/// if there is as much: those first that move most easily.
[[nodiscard]] std::vector<Offer> offers_of(const Contribution& contribution, std::span<const Part> parts,
                                           const DealtParts& dealt, const MoveCost& cost, const Dealing& dealing);

/// What all conclude from the offers: these are dealt as deal_surplus does it.
struct DealtOffers {
  std::vector<Offer> offers;     ///< of all ranks, by the numbers of the subdomains
  std::vector<Rank> takers;      ///< of each: its part's, another one, or its holder
  IdVector<Rank, double> times;  ///< when each rank would be through if all moved that is dealt to another
};
[[nodiscard]] DealtOffers deal_offers(const IdVector<Rank, RankLoad>& states, std::span<const Bundle> bundles,
                                      std::span<const Offer> offers, const DealtParts& dealt, const Dealing& dealing,
                                      const MoveCost& cost);

/// What this rank should hand over: of what was dealt to others, what it cannot keep without being through later than
/// the last one then, or than the ideal time and the slack of `worth`.
[[nodiscard]] std::vector<Move> moves_of(const Contribution& contribution, std::span<const Part> parts,
                                         const IdVector<Rank, RankLoad>& states, const DealtParts& dealt,
                                         const DealtOffers& offers, const MoveCost& cost, const Worth& worth);

/// All that one rank would hand over to another.
struct Transfer {
  Rank from{}, to{};
  double work = 0;
  std::uint64_t bytes = 0;
  std::int32_t count = 0;  ///< of subdomains
};
[[nodiscard]] std::vector<Transfer> transfers_of(const Contribution& contribution, std::span<const Move> moves);

/// What all conclude from the transfers: that all of them are made, or none.
struct JointPlan {
  struct Coming {
    double work = 0;
    std::int32_t count = 0;  ///< of subdomains
  };
  bool worth = false;               ///< whether they are made
  IdVector<Rank, RankLoad> states;  ///< of all ranks when everything has arrived
  IdVector<Rank, Coming> coming;    ///< what goes to each rank
};
[[nodiscard]] JointPlan weigh(const IdVector<Rank, RankLoad>& states, std::span<const Transfer> transfers,
                              const MoveCost& cost, const Worth& worth);

}  // namespace driftmesh::balancer
