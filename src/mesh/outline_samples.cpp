#include "mesh/outline_samples.hpp"

#include <algorithm>
#include <utility>

#include "geometry/box_tree.hpp"
#include "geometry/midpoint.hpp"
#include "geometry/segment_geometry.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/cdt.hpp"

namespace driftmesh {
namespace {

/// Between segments that do not cross.
double squared_distance_between(const Point& a, const Point& b, const Point& c, const Point& d) {
  return std::min({squared_distance_to_segment(a, c, d), squared_distance_to_segment(b, c, d),
                   squared_distance_to_segment(c, a, b), squared_distance_to_segment(d, a, b)});
}

/// Whether a corner is less than a right angle.
bool is_sharp(const Point& before, const Point& at, const Point& after) {
  return (before.x - at.x) * (after.x - at.x) + (before.y - at.y) * (after.y - at.y) > 0;
}

/// Banks that follow each other do only if they make a sharp corner.
bool can_face(std::span<const Point> points, const Bank& s, const Bank& t) {
  if (s.a == t.a || s.b == t.b) return false;  // the same bank, or rings that touch: others face them, too
  if (s.b == t.a) return is_sharp(points[s.a], points[s.b], points[t.b]);
  if (t.b == s.a) return is_sharp(points[t.a], points[s.a], points[s.b]);
  return true;
}

}  // namespace

std::vector<Bank> banks_of(const Triangulation& mesh) {
  std::vector<Bank> banks;
  for (const TriangleId t : ids_of(mesh.triangles)) {
    if (!mesh.triangles[t].alive()) continue;
    for (int i = 0; i < 3; ++i) {
      const HalfEdge h = half_edge(t, i);
      if (mesh.across(h) != kNone) continue;
      const RootSegment& root = mesh.roots[mesh.subsegments[subsegment_of(mesh.twin(h))].root];
      banks.push_back({mesh.origin[mesh.edge_start(h)], mesh.origin[mesh.edge_end(h)], root.marker});
    }
  }
  return banks;
}

OutlineSamples::OutlineSamples(std::span<const Point> points, std::vector<Bank> banks, double width, double spacing)
    : banks_(std::move(banks)) {
  std::vector<Box> boxes;
  std::vector<std::int32_t> corner(points.size(), kNone);
  for (const std::int32_t b : first_ids<std::int32_t>(banks_.size())) {
    for (const std::int32_t end : {banks_[b].a, banks_[b].b}) {
      if (corner[end] == kNone) {
        corner[end] = corners();
        original_.push_back(end);
        points_.push_back(points[end]);
        at_corner_.emplace_back();
      }
      at_corner_[corner[end]].push_back(b);
    }
    boxes.push_back(Box::around(points[banks_[b].a], points[banks_[b].b]));
  }
  const BoxTree tree(boxes);
  for (const std::int32_t b : first_ids<std::int32_t>(banks_.size())) {
    const auto is_near = [&](const Point& p, const Point& q) {
      const Box around = Box::around(p, q, width);
      bool found = false;
      tree.search([&](const Box& box) { return !found && box.overlaps(around); },
                  [&](std::int32_t i) {
                    const Bank& other = banks_[i];
                    found =
                        found || (can_face(points, banks_[b], other) &&
                                  squared_distance_between(p, q, points[other.a], points[other.b]) <= width * width);
                  });
      return found;
    };
    add_pieces(b, corner[banks_[b].a], corner[banks_[b].b], spacing, is_near);
  }
}

template <class Near>
void OutlineSamples::add_pieces(std::int32_t bank, std::int32_t from, std::int32_t to, double spacing,
                                const Near& near) {
  const Point p = points_[from], q = points_[to], middle = midpoint(p, q);
  if (squared_distance(p, q) <= spacing * spacing || middle == p || middle == q || !near(p, q)) {
    pieces_.push_back({from, to, bank});
    return;
  }
  const auto sample = static_cast<std::int32_t>(points_.size());
  points_.push_back(middle);
  of_sample_.push_back(bank);
  add_pieces(bank, from, sample, spacing, near);
  add_pieces(bank, sample, to, spacing, near);
}

Triangulation OutlineSamples::triangulated() const {
  Pslg domain;
  domain.points = points_;
  std::vector<SegmentSides> sides;
  for (const std::int32_t i : first_ids<std::int32_t>(pieces_.size())) {
    const auto [from, to] = std::minmax(pieces_[i].from, pieces_[i].to);  // the direction of roots
    domain.segments.push_back({from, to, i});
    sides.push_back(from == pieces_[i].from ? SegmentSides{.left = 0} : SegmentSides{.right = 0});
  }
  return triangulate(domain, sides);
}

}  // namespace driftmesh
