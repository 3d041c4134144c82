#pragma once

namespace driftmesh {

/// How a rank spent its time, in seconds: the categories of the paper's Figure 11. They add up to the time from the
/// first step of its loop to the last.
struct RankTimes {
  double computing = 0;  ///< refinement, and the initial triangulations of subdomains
  double sending = 0;    ///< encoding messages and giving them to the transport
  double polling = 0;    ///< receiving and decoding messages, while there was work
  double balancing =
      0;            ///< deciding on moves, and waiting for others to decide together; packing and unpacking subdomains
  double idle = 0;  ///< nothing to do until a message comes
  [[nodiscard]] double total() const { return computing + sending + polling + balancing + idle; }
};

}  // namespace driftmesh
