#include "verify/arrangement.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "base/disjoint_sets.hpp"
#include "driftmesh/id_vector.hpp"
#include "geometry/predicates.hpp"
#include "verify/arrangement_sweep.hpp"

namespace driftmesh {
namespace {

constexpr std::int32_t kNoLoop = -1;

// Whether the way from `from` to `to` points into the right half plane, straight up included.
bool points_right(const Point& from, const Point& to) {
  return to.x > from.x || (to.x == from.x && to.y > from.y);
}

}  // namespace

Arrangement::Arrangement(std::vector<Point> points, std::vector<Link> links, std::vector<Point> queries)
    : points_(std::move(points)), links_(std::move(links)), queries_(std::move(queries)) {
  ArrangementSweep sweep(points_, links_, queries_);
  sweep.run();
  conflict_ = sweep.conflict();
  if (conflict_) return;
  sort_outgoing();
  join_faces(sweep.below_point(), sweep.below_query());
}

std::int32_t Arrangement::tail(std::int32_t half) const {
  const Link& link = links_[half / 2];
  return half % 2 == 0 ? link.a : link.b;
}

std::span<const std::int32_t> Arrangement::outgoing(std::int32_t point) const {
  const auto first = first_outgoing_[point], last = first_outgoing_[point + 1];
  return std::span(outgoing_).subspan(first, last - first);
}

// Counterclockwise from straight down (exclusive): the right half plane comes first.
void Arrangement::sort_outgoing() {
  first_outgoing_.assign(points_.size() + 1, 0);
  for (const Link& link : links_) ++first_outgoing_[link.a + 1], ++first_outgoing_[link.b + 1];
  std::partial_sum(first_outgoing_.begin(), first_outgoing_.end(), first_outgoing_.begin());
  outgoing_.resize(2 * links_.size());
  std::vector<std::int32_t> next(first_outgoing_.begin(), first_outgoing_.end() - 1);
  for (const std::int32_t half : first_ids<std::int32_t>(outgoing_.size())) outgoing_[next[tail(half)]++] = half;
  for (std::size_t p = 0; p < points_.size(); ++p) {
    const Point& center = points_[p];
    std::sort(outgoing_.begin() + first_outgoing_[p], outgoing_.begin() + first_outgoing_[p + 1],
              [&](std::int32_t a, std::int32_t b) {
                const Point &to_a = points_[tail(a ^ 1)], &to_b = points_[tail(b ^ 1)];
                const bool right_a = points_right(center, to_a), right_b = points_right(center, to_b);
                return right_a != right_b ? right_a : orient2d(center, to_a, to_b) > 0;
              });
  }
}

// The loop that each half-edge belongs to: the boundary of a face, or a part of it, walked with the face on the left.
std::vector<std::int32_t> Arrangement::trace_loops() {
  std::vector<std::int32_t> next(outgoing_.size());  // at the head: the outgoing half-edge clockwise from the way back
  for (std::size_t p = 0; p < points_.size(); ++p) {
    const auto fan = outgoing(static_cast<std::int32_t>(p));
    for (std::size_t i = 0; i < fan.size(); ++i) next[fan[i] ^ 1] = fan[(i + fan.size() - 1) % fan.size()];
  }
  std::vector<std::int32_t> loop(outgoing_.size(), kNoLoop);
  std::int32_t loops = 0;
  for (const std::int32_t start : first_ids<std::int32_t>(loop.size())) {
    if (loop[start] != kNoLoop) continue;
    for (std::int32_t half = start; loop[half] == kNoLoop; half = next[half]) loop[half] = loops;
    ++loops;
  }
  return loop;
}

// A connected set of links lies in the face directly below its lexicographically lowest point; the loop that faces
// left there is its outer one and bounds that face.
void Arrangement::join_faces(const std::vector<std::int32_t>& below_point,
                             const std::vector<std::int32_t>& below_query) {
  const std::vector<std::int32_t> loop = trace_loops();
  const std::int32_t loops = loop.empty() ? 0 : *std::max_element(loop.begin(), loop.end()) + 1;
  const std::int32_t infinity = loops;
  DisjointSets sets(loops + 1);
  const auto loop_above = [&](std::int32_t link) {
    if (link == ArrangementSweep::kNothing) return infinity;
    const Link& l = links_[link];
    return loop[side(link, !points_right(points_[l.a], points_[l.b]))];
  };
  for (std::size_t p = 0; p < points_.size(); ++p) {
    const auto fan = outgoing(static_cast<std::int32_t>(p));
    const bool faces_left = !fan.empty() && points_right(points_[p], points_[tail(fan.back() ^ 1)]);
    if (faces_left) sets.join(loop[fan.back()], loop_above(below_point[p]));
  }

  std::vector<std::int32_t> face_of_root(loops + 1, -1);
  face_of_root[sets.find(infinity)] = kUnbounded;
  loops_of_face_.assign(1, 0);
  const auto face_of_loop = [&](std::int32_t l) {
    std::int32_t& face = face_of_root[sets.find(l)];
    if (face < 0) {
      face = static_cast<std::int32_t>(loops_of_face_.size());
      loops_of_face_.push_back(0);
    }
    return face;
  };
  for (std::int32_t l = 0; l < loops; ++l) ++loops_of_face_[face_of_loop(l)];
  face_of_side_.resize(loop.size());
  for (std::size_t half = 0; half < loop.size(); ++half) face_of_side_[half] = face_of_loop(loop[half]);
  face_of_point_.assign(points_.size(), kOnBoundary);
  for (std::size_t p = 0; p < points_.size(); ++p) {
    if (!outgoing(static_cast<std::int32_t>(p)).empty()) continue;
    face_of_point_[p] = face_of_loop(loop_above(below_point[p]));
    ++loops_of_face_[face_of_point_[p]];
  }
  face_of_query_.reserve(below_query.size());
  for (const std::int32_t below : below_query)
    face_of_query_.push_back(below == ArrangementSweep::kOn ? kOnBoundary : face_of_loop(loop_above(below)));
}

}  // namespace driftmesh
