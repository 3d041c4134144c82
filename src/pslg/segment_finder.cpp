#include "pslg/segment_finder.hpp"

#include <utility>

namespace driftmesh {

SegmentFinder::SegmentFinder(const Pslg& pslg)
    : segments_(pslg.segments), begin_(pslg.points.size() + 2, 0), at_(2 * pslg.segments.size()) {
  for (const Pslg::Segment& s : segments_)
    for (const std::int32_t end : {s.a, s.b}) ++begin_[end + 2];
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  std::int32_t index = 0;
  for (const Pslg::Segment& s : segments_) {
    for (const std::int32_t end : {s.a, s.b}) at_[begin_[end + 1]++] = index;
    ++index;
  }
}

std::int32_t SegmentFinder::between(std::int32_t a, std::int32_t b) const {
  if (begin_[b + 1] - begin_[b] < begin_[a + 1] - begin_[a]) std::swap(a, b);
  for (std::size_t i = begin_[a]; i < begin_[a + 1]; ++i)
    if (const Pslg::Segment& s = segments_[at_[i]]; (s.a == a && s.b == b) || (s.a == b && s.b == a)) return at_[i];
  return -1;
}

}  // namespace driftmesh
