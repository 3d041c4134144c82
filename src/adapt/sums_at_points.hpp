#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "adapt/generation.hpp"
#include "distributed/ranks.hpp"
#include "driftmesh/id_vector.hpp"
#include "driftmesh/ids.hpp"

namespace driftmesh::adapt {

/// Sums at the points of a mesh of what subdomains have there, `width` numbers each. They are formed in the order
/// of the subdomains' numbers, so they have the same bits whichever ranks and threads have them.
class SumsAtPoints {
 public:
  /// The generation outlives the object.
  SumsAtPoints(const Generation& generation, std::size_t width);

  /// What a subdomain has at one of its points; at most once. One thread at a time for each subdomain.
  void add(SubdomainId s, std::int32_t point, std::span<const double> values);
  /// The sums at all points, once all subdomains have been added. Collective.
  [[nodiscard]] std::vector<double> take(Ranks& ranks);

 private:
  /// What a subdomain has at points that it shares with others.
  struct AtBorders {
    std::vector<std::int32_t> points;
    std::vector<double> values;
  };

  const DistributedPiece& piece_;
  std::size_t width_;
  std::vector<double> sums_;
  std::vector<bool> is_shared_;  // with other ranks
  std::vector<bool> is_common_;  // to several subdomains, here or elsewhere
  IdVector<SubdomainId, AtBorders> at_borders_;
};

}  // namespace driftmesh::adapt
