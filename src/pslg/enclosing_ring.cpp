#include "pslg/enclosing_ring.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "driftmesh/id_vector.hpp"
#include "geometry/predicates.hpp"

namespace driftmesh {
namespace {

bool points_up(const Point& from, const Point& to) {
  return to.y > from.y || (to.y == from.y && to.x > from.x);
}

std::vector<Box> boxes_of(const Pslg& pslg) {
  std::vector<Box> boxes;
  for (const Pslg::Segment& s : pslg.segments) boxes.push_back(Box::around(pslg.points[s.a], pslg.points[s.b]));
  return boxes;
}

}  // namespace

EnclosingRings::EnclosingRings(const Pslg& pslg)
    : pslg_(pslg), tree_(boxes_of(pslg)), box_(Box::of(pslg.points)), first_(pslg.points.size() + 1, 0) {
  for (const Pslg::Segment& s : pslg.segments)
    for (const std::int32_t end : {s.a, s.b}) ++first_[to_index(end) + 1];
  for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
  leaving_.resize(2 * pslg.segments.size());
  std::vector<std::int32_t> place(first_.begin(), first_.end() - 1);
  for (const std::int32_t half : first_ids<std::int32_t>(leaving_.size()))
    leaving_[to_index(place[to_index(tail(half))]++)] = half;
  for (std::size_t v = 0; v + 1 < first_.size(); ++v)
    std::sort(leaving_.begin() + first_[v], leaving_.begin() + first_[v + 1], [&](std::int32_t g, std::int32_t h) {
      const Point &o = pslg_.points[v], &p = at(g ^ 1), &q = at(h ^ 1);
      const bool up = points_up(o, p);
      return up != points_up(o, q) ? up : orient2d(o, p, q) > 0;
    });
}

std::int32_t EnclosingRings::tail(std::int32_t half) const {
  const Pslg::Segment& s = pslg_.segments[to_index(half / 2)];
  return half % 2 == 0 ? s.a : s.b;
}

std::span<const std::int32_t> EnclosingRings::leaving(std::int32_t vertex) const {
  const auto begin = to_index(first_[to_index(vertex)]), end = to_index(first_[to_index(vertex) + 1]);
  return std::span(leaving_).subspan(begin, end - begin);
}

/// The half-edge that follows along the border of the area on the left: at its end the first one clockwise from there.
std::int32_t EnclosingRings::next(std::int32_t half) const {
  const std::span<const std::int32_t> around = leaving(tail(half ^ 1));
  const auto back = std::ranges::find(around, half ^ 1);
  return back == around.begin() ? around.back() : *(back - 1);
}

/// The half-edge nearest on the right of `p` that has `p` on its left; kNone if there is none. Leaves out the segments
/// of the vertex `beside`.
std::int32_t EnclosingRings::to_the_right_of(const Point& p, std::int32_t beside) const {
  std::int32_t found = kNone;
  double nearest = std::numeric_limits<double>::infinity();
  const Box ray = Box::around(p, {std::max(p.x, box_.high.x), p.y});
  tree_.search([&](const Box& box) { return box.overlaps(ray); },
               [&](std::int32_t i) {
                 const Pslg::Segment& s = pslg_.segments[to_index(i)];
                 const Point &a = pslg_.points[to_index(s.a)], &b = pslg_.points[to_index(s.b)];
                 if (s.a == beside || s.b == beside || (a.y <= p.y) == (b.y <= p.y)) return;
                 const double side = orient2d(a, b, p);
                 const bool upward = a.y < b.y;
                 if (side == 0 || (side > 0) != upward) return;
                 const double x = a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x);
                 if (!(x < nearest)) return;
                 nearest = x;
                 found = 2 * i + (upward ? 0 : 1);
               });
  return found;
}

EnclosingRings::Walk EnclosingRings::walk(std::int32_t first) const {
  Walk found;
  found.rightmost = tail(first);
  const Point& origin = at(first);
  std::int32_t half = first;
  do {
    const Point &a = at(half), &b = at(half ^ 1);
    found.twice_area += (a.x - origin.x) * (b.y - origin.y) - (a.y - origin.y) * (b.x - origin.x);
    found.length += std::hypot(b.x - a.x, b.y - a.y);
    if (a.x > pslg_.points[to_index(found.rightmost)].x) found.rightmost = tail(half);
    half = next(half);
  } while (half != first);
  return found;
}

std::optional<EnclosingRing> EnclosingRings::around(const Point& p) const {
  std::int32_t half = to_the_right_of(p, kNone);
  while (half != kNone) {
    const Walk found = walk(half);
    if (found.twice_area > 0) return EnclosingRing{found.twice_area / 2, found.length};
    // Something inside the same area: on from there.
    half = to_the_right_of(pslg_.points[to_index(found.rightmost)], found.rightmost);
  }
  return std::nullopt;
}

}  // namespace driftmesh
