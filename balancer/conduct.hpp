#pragma once

#include <vector>

#include "balancer/snapshot/messages.hpp"

namespace driftmesh::balancer {

/// Balancing actions of a rank at one moment.
struct Decision {
  std::vector<Move> moves;  ///< hand these over, now
  std::vector<Move> asks;   ///< moves that their destinations are to be asked for first (see Admissions)
  std::vector<Outgoing> messages;
  bool planned = false;  ///< planning was considered, which may have taken long: call took()
};

}  // namespace driftmesh::balancer
