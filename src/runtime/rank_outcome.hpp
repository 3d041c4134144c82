#pragma once

#include <cstdint>

#include "protocol/rank_protocol.hpp"
#include "runtime/rank_times.hpp"

namespace driftmesh {

/// Results of one rank in a run.
struct RankOutcome {
  RankTimes times;
  protocol::ProtocolCounters counters;
  std::int64_t triangles = 0;                     ///< sum over the subdomains that it holds
  std::int32_t subdomains = 0;                    ///< number that it holds
  std::int64_t interface_splits = 0;              ///< points that refinement put on interfaces here
  std::uint64_t messages = 0, message_bytes = 0;  ///< sent, termination included
};

}  // namespace driftmesh
