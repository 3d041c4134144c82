#include "protocol/aggregator.hpp"

#include <algorithm>
#include <utility>

#include "driftmesh/error.hpp"

namespace driftmesh::protocol {

Aggregator::Aggregator(Rank self, std::size_t threshold) : self_(self), threshold_(threshold) {
  if (threshold == 0) throw Error("aggregation of 0 SPLITs a message; give 1 to send each at once");
}

std::optional<Outgoing> Aggregator::add(Rank destination, SubdomainId to, Epoch epoch,
                                        const SplitPoint<GlobalRootId>& split) {
  auto& buffer = buffers_[destination];
  if (buffer.empty()) filled_.push_back(destination);
  buffer.push_back({to, epoch, split});
  ++size_;
  if (buffer.size() < threshold_) return std::nullopt;
  std::erase(filled_, destination);
  return take(destination);
}

std::vector<Outgoing> Aggregator::flush() {
  std::vector<Outgoing> batches;
  for (const Rank destination : std::exchange(filled_, {})) batches.push_back(take(destination));
  return batches;
}

// One group for each subdomain and epoch; within a group the order of arrival, which is free but easier to follow.
Outgoing Aggregator::take(Rank destination) {
  auto buffer = std::move(buffers_.extract(destination).mapped());
  size_ -= buffer.size();
  const auto key = [](const Waiting& w) { return std::pair(w.to, w.epoch); };
  std::stable_sort(buffer.begin(), buffer.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
  SplitBatch batch;
  for (const Waiting& w : buffer) {
    if (batch.groups.empty() || key(w) != std::pair(batch.groups.back().to, batch.groups.back().epoch))
      batch.groups.push_back({w.to, w.epoch, self_, 0, {}});
    batch.groups.back().points.push_back(w.split);
  }
  return {destination, std::move(batch)};
}

}  // namespace driftmesh::protocol
