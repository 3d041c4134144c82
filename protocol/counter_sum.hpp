#pragma once

#include <algorithm>

#include "protocol/rank_protocol.hpp"

namespace driftmesh::protocol {

/// What ranks counted together: sums, and the most hops of any of them.
inline ProtocolCounters& operator+=(ProtocolCounters& sum, const ProtocolCounters& part) {
  sum.splits_sent += part.splits_sent;
  sum.splits_handled += part.splits_handled;
  sum.batches_sent += part.batches_sent;
  sum.hand_offs += part.hand_offs;
  sum.hand_off_bytes += part.hand_off_bytes;
  sum.arrivals += part.arrivals;
  sum.forwarded += part.forwarded;
  sum.most_hops = std::max(sum.most_hops, part.most_hops);
  sum.held += part.held;
  return sum;
}

}  // namespace driftmesh::protocol
