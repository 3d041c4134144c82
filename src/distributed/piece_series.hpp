#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "distributed/census.hpp"
#include "distributed/numbering.hpp"
#include "driftmesh/distributed_piece.hpp"
#include "driftmesh/pslg.hpp"
#include "migration/subdomain.hpp"

namespace driftmesh {

/// About this many triangles make a piece in a series: some hundred megabytes while it is written.
inline constexpr double kTrianglesInSeries = 5e6;

/// The mesh that one process holds as a series of pieces, each made when it is asked for: a mesh in subdomains that
/// sleep can be written without waking them all at once. Each piece consists of consecutive subdomains. How many there
/// are depends on the decomposition alone. Threads may make different pieces at the same time.
class PieceSeries {
 public:
  /// The number of pieces.
  [[nodiscard]] static std::int32_t count(const Decomposition& decomposition);

  /// `census` is that of all subdomains, ascending. All arguments must outlive the object. Throws Error if the sides of
  /// a root have different points.
  PieceSeries(const Decomposition& decomposition, const std::map<SubdomainId, Subdomain>& subdomains,
              std::vector<SubdomainCensus> census, const Pslg& pslg);

  [[nodiscard]] std::int32_t size() const { return to_int(subdomains_.rank.back()) + 1; }
  /// Piece `k`, as if rank `k` of so many held its subdomains.
  [[nodiscard]] DistributedPiece piece(Rank k) const;

 private:
  const Decomposition& decomposition_;
  const std::map<SubdomainId, Subdomain>& held_;
  const Pslg& pslg_;
  std::vector<SubdomainCensus> census_;
  SubdomainTable subdomains_;
  std::vector<NumberedRoot> roots_;  // roots in all pieces, ascending
};

}  // namespace driftmesh
