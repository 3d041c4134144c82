#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "decompose/decomposition.hpp"
#include "driftmesh/ids.hpp"
#include "driftmesh/options.hpp"

namespace driftmesh {

/// The rank of each subdomain.
using Assignment = IdVector<SubdomainId, Rank>;

/// The quantity to balance.
enum class MappingWeight {
  kWork,  ///< predicted triangles
  kArea,  ///< for experiments: a mapping that ignores the sizes of triangles
};

struct MappingOptions {
  std::int32_t ranks = 1;
  /// Relative speed of each rank: work is mapped in proportion (round-robin ignores it). Empty: all equal.
  IdVector<Rank, double> speeds;
  MappingMethod method = MappingMethod::kGraph;
  MappingWeight weight = MappingWeight::kWork;
  IdVector<Rank, bool> absent{};  ///< these ranks get nothing; empty: none of them
};

/// Maps subdomains to ranks by weight. Deterministic. A rank may be left without work if there are not many more
/// subdomains than ranks. Throws Error for options out of range, and if all ranks are absent.
[[nodiscard]] Assignment map_subdomains(const Decomposition& decomposition, const MappingOptions& options);

/// Quality of a mapping.
struct MappingReport {
  double largest_load = 0;         ///< work of a rank over its speed, in units of the mean: 1 is perfect
  double interface_length = 0;     ///< interfaces between ranks
  double share_between_ranks = 0;  ///< fraction of the length of all interfaces
};
[[nodiscard]] MappingReport report_mapping(const Decomposition& decomposition, const Assignment& assignment,
                                           const MappingOptions& options);

}  // namespace driftmesh
