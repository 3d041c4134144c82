#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "driftmesh/load_snapshot.hpp"

namespace driftmesh::balancer {

/// Who plans, and with what knowledge. Controller implements each placement. There is no kCollective any more: plan on
/// rank 0 (kLeader), or on each rank for its own subdomains (kNeighbors).
enum class Placement {
  kNobody,     ///< nothing is reported, nothing moves
  kLeader,     ///< all ranks report to rank 0, which plans for all
  kNeighbors,  ///< ranks whose subdomains touch, and a few distant ones, report to each other; each plans for its own
  kRequests,   ///< a rank that will soon be idle asks for work; rank 0 finds a rank that has plenty
};

/// Decides which rank should work on which subdomains. Its functions depend on their arguments alone: the same snapshot
/// yields the same moves. Exceptions they throw end the run on all ranks. They need not consider whether moves are
/// worth their cost; the caller does.
class Policy {
 public:
  virtual ~Policy() = default;
  Policy(const Policy&) = delete;
  Policy& operator=(const Policy&) = delete;

  [[nodiscard]] virtual Placement placement() const = 0;

  /// kLeader: moves of any subdomains. kNeighbors: moves of subdomains that `self` owns. Each subdomain moves at most
  /// once, and never to its owner.
  [[nodiscard]] virtual std::vector<Move> plan(const LoadSnapshot& snapshot, Rank self) const;

  /// kLeader: moves of single subdomains, which are made where plan() would not pay off as a whole. Either is mended
  /// first (docs/balancing.md): other subdomains may move, and to other ranks. If none of these moves is worth making,
  /// plan() is not asked: what remains is too little for new parts. Without them (the default) it always is, and
  /// reduced to those moves that pay off.
  [[nodiscard]] virtual std::optional<std::vector<Move>> touch_up(const LoadSnapshot& snapshot) const;

  /// kLeader: how long plan() takes, in seconds on the machine in docs/benchmarks.md. Beside touch_up(), it is asked
  /// only if more than that can be gained. 0, the default: that does not matter.
  [[nodiscard]] virtual double planning_seconds(const LoadSnapshot& snapshot) const;

  /// kLeader: how many times as many moves as touch_up() plan() may have and still be made where both finish about as
  /// early. The default, infinity, does not count moves.
  [[nodiscard]] virtual double most_moves() const;

  /// kRequests: whether a rank should ask for more that has this many seconds of work after the subdomain at hand,
  /// less those that it takes to get some.
  [[nodiscard]] virtual bool runs_low(double seconds) const;
  /// kRequests: the rank from which `thief` should get work, if any. `able` tells for each rank whether it has work to
  /// give. The snapshot lists no subdomains.
  [[nodiscard]] virtual std::optional<Rank> victim(const LoadSnapshot& snapshot, Rank thief,
                                                   const IdVector<Rank, bool>& able) const;
  /// kRequests: what `self` gives to the requesting rank `to`, out of the subdomains that the snapshot lists as its
  /// own.
  [[nodiscard]] virtual std::vector<Move> give(const LoadSnapshot& snapshot, Rank self, Rank to) const;

 protected:
  Policy() = default;
};

/// A policy of placement kLeader from a function that maps the load of all ranks to moves. The result must depend on
/// its argument alone.
///
/// \code
/// using namespace driftmesh::balancer;
/// const auto to_the_first = [](const LoadSnapshot& load) {  // all that waits on other ranks
///   std::vector<Move> moves;
///   for (const SubdomainLoad& s : load.subdomains)
///     if (s.owner != driftmesh::Rank{0} && s.turn > 0 && !s.fixed) moves.push_back({s.id, driftmesh::Rank{0}});
///   return moves;
/// };
/// const driftmesh::MeshOptions options{.max_area = 50, .balance = {.own = leader_policy(to_the_first)}};
/// \endcode
[[nodiscard]] std::shared_ptr<const Policy> leader_policy(
    std::function<std::vector<Move>(const LoadSnapshot& snapshot)> plan);

}  // namespace driftmesh::balancer
