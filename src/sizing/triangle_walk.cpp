#include "sizing/triangle_walk.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

#include "base/narrow.hpp"
#include "geometry/box.hpp"
#include "geometry/predicates.hpp"

namespace driftmesh {

TriangleWalk::TriangleWalk(const std::vector<Point>& points, const std::vector<Triangle>& triangles,
                           const std::vector<Triangle>& neighbors) {
  const auto point = [&](std::int32_t i) { return points[i]; };
  Box all;
  for (const Triangle& triangle : triangles)
    for (const std::int32_t i : triangle) all.extend(point(i));
  order_ = HilbertOrder(all.low, all.high);

  std::vector<std::uint64_t> place(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Point a = point(triangles[t][0]), b = point(triangles[t][1]), c = point(triangles[t][2]);
    place[t] = order_.index({(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3});
  }
  std::vector<std::uint32_t> sorted(triangles.size());
  std::iota(sorted.begin(), sorted.end(), 0U);
  std::stable_sort(sorted.begin(), sorted.end(), [&](auto s, auto t) { return place[s] < place[t]; });

  std::vector<std::int32_t> node_of(triangles.size());
  for (std::size_t n = 0; n < sorted.size(); ++n)
    node_of[sorted[n]] = narrow<std::int32_t>(n, "triangles of the background mesh");
  for (const std::uint32_t t : sorted) {
    Node& node = nodes_.emplace_back();
    node.triangle = static_cast<std::int32_t>(t);
    for (std::size_t i = 0; i < 3; ++i) {
      node.corner[i] = point(triangles[t][i]);
      const std::int32_t neighbor = neighbors[t][i];
      node.next[i] = neighbor < 0 ? -1 : node_of[neighbor];
    }
    places_.push_back(place[t]);
  }

  // About one node per bucket, so that there is little left to search.
  const int bits = std::bit_width(nodes_.size());
  bucket_shift_ = 64 - bits;
  bucket_.resize((std::size_t{1} << bits) + 1);
  for (std::size_t b = 0, n = 0; b < bucket_.size(); ++b) {
    while (n < places_.size() && places_[n] >> bucket_shift_ < b) ++n;
    bucket_[b] = static_cast<std::uint32_t>(n);
  }
}

std::size_t TriangleWalk::start_for(const Point& p) const {
  const std::uint64_t place = order_.index(p);
  const std::size_t bucket = place >> bucket_shift_;
  const auto begin = places_.begin();
  const auto found = std::lower_bound(begin + bucket_[bucket], begin + bucket_[bucket + 1], place);
  return std::min<std::size_t>(found - begin, nodes_.size() - 1);
}

TriangleWalk::Found TriangleWalk::find(const Point& p) const {
  if (nodes_.empty()) return {};
  std::size_t at = start_for(p);
  for (int step = 0; step < kMaxSteps; ++step) {
    const Node& node = nodes_[at];
    const auto& [a, b, c] = node.corner;
    const std::array<double, 3> opposite{orient2d(b, c, p), orient2d(c, a, p), orient2d(a, b, p)};
    const std::size_t least = std::min_element(opposite.begin(), opposite.end()) - opposite.begin();
    if (opposite[least] > 0) return {node.triangle, opposite};
    const std::int32_t next = node.next[(least + 1) % 3];
    if (opposite[least] == 0 || next < 0) return {};
    at = next;
  }
  return {};
}

}  // namespace driftmesh
