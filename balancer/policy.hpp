#pragma once

#include <optional>
#include <vector>

#include "balancer/load_snapshot.hpp"

namespace driftmesh::balancer {

/// Who plans, and on what knowledge. Controller does what each of them needs.
enum class Placement {
  kNobody,      ///< nothing is reported, nothing moves
  kLeader,      ///< all report to rank 0, which plans for all
  kNeighbours,  ///< ranks whose subdomains touch report to each other; each plans for what it owns
  kRequests,    ///< a rank that will soon be idle asks for work; rank 0 finds it a rank that has much
};

/// Decides who should work on what. Its functions depend on their arguments alone: the same snapshot yields the same
/// moves. They need not look at the cost of moving, nor at whether it is worth while: worth_moving does.
class Policy {
 public:
  virtual ~Policy() = default;
  Policy(const Policy&) = delete;
  Policy& operator=(const Policy&) = delete;

  [[nodiscard]] virtual Placement placement() const = 0;

  /// kLeader: moves of any subdomains. kNeighbours: moves of subdomains that `self` owns. Each subdomain at most once,
  /// to another rank than its owner.
  [[nodiscard]] virtual std::vector<Move> plan(const LoadSnapshot& snapshot, Rank self) const;

  /// kRequests: whether a rank with so many seconds of work left should ask for more.
  [[nodiscard]] virtual bool runs_low(double seconds) const;
  /// kRequests: the rank that `thief` should get work from, if any. `able` says of each rank whether it has something
  /// to give. The snapshot lists no subdomains.
  [[nodiscard]] virtual std::optional<Rank> victim(const LoadSnapshot& snapshot, Rank thief,
                                                   const std::vector<bool>& able) const;
  /// kRequests: what `self` gives to a rank that has asked; of what the snapshot lists as its own.
  [[nodiscard]] virtual std::vector<Move> give(const LoadSnapshot& snapshot, Rank self, Rank to) const;

 protected:
  Policy() = default;
};

}  // namespace driftmesh::balancer
