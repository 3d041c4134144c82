#pragma once

#include <cstdint>
#include <vector>

#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// Finds the segments of a graph by their ends.
class SegmentFinder {
 public:
  /// The segments' ends must be indices of points.
  explicit SegmentFinder(const Pslg& pslg);

  /// The first segment between two points, in either direction; -1 if there is none. Takes as long as the point with
  /// fewer segments has segments.
  [[nodiscard]] std::int32_t between(std::int32_t a, std::int32_t b) const;

 private:
  const std::vector<Pslg::Segment>& segments_;
  std::vector<std::size_t> begin_;  // for each point, where its part of at_ begins; and the end
  std::vector<std::int32_t> at_;    // segments, by their ends
};

}  // namespace driftmesh
