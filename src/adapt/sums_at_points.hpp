#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "distributed/ranks.hpp"
#include "driftmesh/distributed_piece.hpp"
#include "driftmesh/ids.hpp"

namespace driftmesh::adapt {

/// Sums at the points of a mesh of what subdomains have there, `width` numbers each. They are formed in the order of
/// the subdomains' numbers, so they have the same bits whichever ranks hold them.
class SumsAtPoints {
 public:
  /// The piece outlives the object.
  SumsAtPoints(const DistributedPiece& piece, std::size_t width);

  /// What a subdomain has at one of its points; at most once. Subdomains in ascending order.
  void add(SubdomainId s, std::int32_t point, std::span<const double> values);
  /// The sums at all points, once all subdomains have been added. Collective.
  [[nodiscard]] std::vector<double> take(Ranks& ranks);

 private:
  using Parts = std::map<SubdomainId, std::vector<double>>;

  const DistributedPiece& piece_;
  std::size_t width_;
  std::vector<double> sums_;
  std::vector<bool> is_shared_;           // with other ranks
  std::map<std::int32_t, Parts> shared_;  // at points that are
};

}  // namespace driftmesh::adapt
