#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "driftmesh/load_snapshot.hpp"

namespace driftmesh::balancer {

/// Who plans, and on what knowledge. Controller does what each of them needs.
enum class Placement {
  kNobody,      ///< nothing is reported, nothing moves
  kLeader,      ///< all report to rank 0, which plans for all
  kNeighbors,   ///< ranks whose subdomains touch report to each other; each plans for what it owns
  kRequests,    ///< a rank that will soon be idle asks for work; rank 0 finds it a rank that has much
  kCollective,  ///< all at the same time, each for what it owns; rank 0 knows sums alone, and calls them together
};

/// Zoltan's parameters by their names, LB_METHOD and the like.
using ZoltanParameters = std::map<std::string, std::string>;

/// How parts that are made for all ranks are dealt to them.
struct Dealing {
  bool polish = true;       ///< parts that are not even are evened out by single subdomains
  double tolerance = 0.02;  ///< of a rank's share
};

/// Decides who should work on what. Its functions depend on their arguments alone: the same snapshot yields the same
/// moves. What they throw ends the job. They need not look at the cost of moving, nor at whether it is worth while:
/// those who call them do.
class Policy {
 public:
  virtual ~Policy() = default;
  Policy(const Policy&) = delete;
  Policy& operator=(const Policy&) = delete;

  [[nodiscard]] virtual Placement placement() const = 0;

  /// kLeader: moves of any subdomains. kNeighbors: moves of subdomains that `self` owns. Each subdomain at most once,
  /// to another rank than its owner.
  [[nodiscard]] virtual std::vector<Move> plan(const LoadSnapshot& snapshot, Rank self) const;

  /// kCollective: how the ranks divide their subdomains into parts, one for each rank and as large as that is fast: by
  /// Zoltan, with these parameters. Without any, each subdomain stays in the part of its owner. Everybody knows the
  /// load of all ranks, and lists what it owns itself; so this may look at the load of ranks alone, and is the same for
  /// all.
  [[nodiscard]] virtual std::optional<ZoltanParameters> partitioning(const LoadSnapshot& own) const;
  /// kCollective: what is done with the parts. It may look at the load of ranks alone, too.
  [[nodiscard]] virtual Dealing dealing(const LoadSnapshot& own) const;

  /// kRequests: whether a rank with so many seconds of work left should ask for more.
  [[nodiscard]] virtual bool runs_low(double seconds) const;
  /// kRequests: the rank that `thief` should get work from, if any. `able` says of each rank whether it has something
  /// to give. The snapshot lists no subdomains.
  [[nodiscard]] virtual std::optional<Rank> victim(const LoadSnapshot& snapshot, Rank thief,
                                                   const IdVector<Rank, bool>& able) const;
  /// kRequests: what `self` gives to a rank that has asked; of what the snapshot lists as its own.
  [[nodiscard]] virtual std::vector<Move> give(const LoadSnapshot& snapshot, Rank self, Rank to) const;

 protected:
  Policy() = default;
};

/// A policy of placement kLeader that is a function: of the load of all ranks, what should move where. It must depend
/// on its argument alone.
[[nodiscard]] std::shared_ptr<const Policy> leader_policy(
    std::function<std::vector<Move>(const LoadSnapshot& snapshot)> plan);

}  // namespace driftmesh::balancer
