#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "balancer/move_cost.hpp"
#include "driftmesh/load_snapshot.hpp"
#include "driftmesh/policy.hpp"

/// A plan that all ranks make together (Placement::kCollective). No rank knows all subdomains: each divides its own
/// into parts, and tells the others how much of each part it holds, and which single subdomains could even out the
/// rest. All ranks receive the same data and derive the same plan from it. Its size is the number of pairs of a rank
/// and a part that share subdomains, far less than the number of subdomains. A transfer from one rank to another pays
/// the latency once, not once per subdomain as in a leader's plan. The steps are pure functions; communication is up to
/// a Council.
namespace driftmesh::balancer {

/// The load that a rank contributes.
struct Contribution {
  Rank rank{};
  RankLoad state;                    ///< its speed, and its work including what is still on its way to it
  std::vector<SubdomainLoad> own;    ///< unfinished ones here, in ascending order of IDs
  std::vector<SubdomainId> settled;  ///< ascending: recent arrivals, which stay
};

/// The same as a policy sees it: the rank's own subdomains, and the states of all ranks.
[[nodiscard]] LoadSnapshot own_snapshot(const Contribution& contribution, std::shared_ptr<const Layout> layout,
                                        IdVector<Rank, RankLoad> states);

/// The subdomains of one part that one rank holds and could give away.
struct Bundle {
  Rank holder{};
  Part part{};
  double work = 0;
  std::uint64_t bytes = 0;
};

/// How much of each part a rank holds, given the parts of its subdomains. Omits subdomains that are not worth packing.
[[nodiscard]] std::vector<Bundle> bundles_of(const Contribution& contribution, std::span<const Part> parts,
                                             const MoveCost& cost);

/// The rank of each part, and the resulting loads.
struct DealtParts {
  IdVector<Part, Rank> rank_of;     ///< each part
  IdVector<Rank, RankLoad> states;  ///< of all ranks afterward
};

/// Assigns parts to ranks like remap_parts.
[[nodiscard]] DealtParts deal_parts(const IdVector<Rank, RankLoad>& states, std::span<const Bundle> bundles,
                                    double tolerance);

/// A single subdomain that may move to a rank other than that of its part.
struct Offer {
  Rank holder{};
  Part part{};
  SubdomainLoad subdomain;  ///< its owner is the rank that takes its part
};

/// Subdomains of this rank with which overloaded ranks could be relieved, for each up to its excess, those first that
/// move most easily.
[[nodiscard]] std::vector<Offer> offers_of(const Contribution& contribution, std::span<const Part> parts,
                                           const DealtParts& dealt, const MoveCost& cost, const Dealing& dealing);

/// The common conclusion from all offers, dealt like in deal_surplus.
struct DealtOffers {
  std::vector<Offer> offers;     ///< of all ranks, sorted by subdomain
  std::vector<Rank> takers;      ///< of each offer: the rank of its part, another rank, or its holder
  IdVector<Rank, double> times;  ///< finishing time of each rank if everything dealt to another rank moves
};
[[nodiscard]] DealtOffers deal_offers(const IdVector<Rank, RankLoad>& states, std::span<const Bundle> bundles,
                                      std::span<const Offer> offers, const DealtParts& dealt, const Dealing& dealing,
                                      const MoveCost& cost);

/// What this rank should hand over: of what was dealt to others, what it cannot keep without finishing later than the
/// last rank, or than the ideal time plus the slack of `worth`.
[[nodiscard]] std::vector<Move> moves_of(const Contribution& contribution, std::span<const Part> parts,
                                         const IdVector<Rank, RankLoad>& states, const DealtParts& dealt,
                                         const DealtOffers& offers, const MoveCost& cost, const Worth& worth);

/// Everything that one rank would hand over to another.
struct Transfer {
  Rank from{}, to{};
  double work = 0;
  std::uint64_t bytes = 0;
  std::int32_t count = 0;  ///< of subdomains
};
[[nodiscard]] std::vector<Transfer> transfers_of(const Contribution& contribution, std::span<const Move> moves);

/// The common conclusion from all transfers: either all of them are made, or none. What is in doubt counts as in the
/// call for the round: not at all once a rank has no work.
struct JointPlan {
  struct Coming {
    double work = 0;
    std::int32_t count = 0;  ///< of subdomains
  };
  bool worth = false;               ///< whether they are made
  IdVector<Rank, RankLoad> states;  ///< of all ranks after everything has arrived
  IdVector<Rank, Coming> coming;    ///< what each rank will receive
};
[[nodiscard]] JointPlan weigh(const IdVector<Rank, RankLoad>& states, std::span<const Transfer> transfers,
                              const MoveCost& cost, const Worth& worth);

}  // namespace driftmesh::balancer
