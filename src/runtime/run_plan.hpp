#pragma once

#include <cstdint>
#include <vector>

#include "decompose/decomposition.hpp"
#include "mesh/bounds.hpp"
#include "protocol/aggregator.hpp"
#include "protocol/ids.hpp"
#include "runtime/agenda.hpp"

namespace driftmesh {

/// What every rank of a parallel run knows from the start, equal on all of them.
struct RunPlan {
  Decomposition decomposition;
  std::vector<protocol::Rank> owners;  ///< of each subdomain at the start
  QualityBounds bounds;
  bool presplit = false;
  std::size_t aggregation = protocol::Aggregator::kDefaultThreshold;  ///< SPLITs in one message at most
  /// Insertions between two looks at the transport: some milliseconds, and most subdomains in one go.
  std::int64_t slice = 16384;
  WorkOrder order = WorkOrder::kGiven;
  std::int64_t max_triangles = INT64_MAX;  ///< on one rank; more is a LimitError
};

/// What a rank of the reference machine needs for its work, in seconds: simulated time passes by it. Measured with
/// `driftmesh_bench_costs` (docs/benchmarks.md).
struct CostModel {
  double start = 29e-6;         ///< of the initial triangulation of a subdomain
  double prepared = 0.17e-6;    ///< more for each of its triangles
  double point = 0.229e-6;      ///< a point inserted by refinement
  double packed_byte = 0.4e-9;  ///< of a subdomain that is packed or unpacked
};

}  // namespace driftmesh
