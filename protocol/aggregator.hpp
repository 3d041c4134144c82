#pragma once

#include <map>
#include <optional>
#include <vector>

#include "driftmesh/defaults.hpp"
#include "protocol/messages.hpp"

namespace driftmesh::protocol {

/// Aggregates SPLITs: one buffer per destination rank, sent as one message when it reaches the threshold or when the
/// rank is idle. (Section 4 of the paper: aggregation.) For termination, buffered SPLITs count as in transit.
class Aggregator {
 public:
  /// A threshold of 1 sends every SPLIT at once. Throws Error for a threshold of 0.
  explicit Aggregator(Rank self, std::size_t threshold = defaults::kAggregation);

  /// Adds a SPLIT for subdomain `to`, which `destination` owns in epoch `epoch` as far as this rank knows. Returns the
  /// batch if it is now full.
  [[nodiscard]] std::optional<Outgoing> add(Rank destination, SubdomainId to, Epoch epoch,
                                            const SplitPoint<GlobalRootId>& split);

  /// Everything buffered, one message per destination.
  [[nodiscard]] std::vector<Outgoing> flush();

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }

 private:
  struct Waiting {
    SubdomainId to;
    Epoch epoch;
    SplitPoint<GlobalRootId> split;
  };
  Outgoing take(Rank destination);

  Rank self_;
  std::size_t threshold_;
  std::size_t size_ = 0;
  std::map<Rank, std::vector<Waiting>> buffers_;  // by destination, none empty: few of many ranks are neighbors
  std::vector<Rank> filled_;                      // their destinations, in the order in which they were begun
};

}  // namespace driftmesh::protocol
