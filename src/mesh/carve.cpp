#include "mesh/carve.hpp"

#include <string>
#include <utility>
#include <vector>

#include "base/narrow.hpp"
#include "driftmesh/error.hpp"
#include "geometry/hilbert_sort.hpp"
#include "geometry/predicates.hpp"

namespace driftmesh {
namespace {

bool holds(const Triangulation& mesh, TriangleId t, const Point& p) {
  for (int i = 0; i < 3; ++i)
    if (orient2d(mesh.corner(t, next(i)), mesh.corner(t, previous(i)), p) < 0) return false;
  return true;
}

/// The last resort of locate(): constrained edges can make a walk go in circles.
TriangleId search_all(const Triangulation& mesh, const Point& p) {
  for (const TriangleId t : ids_of(mesh.triangles))
    if (mesh.triangles[t].alive() && holds(mesh, t, p)) return t;
  return kNone;
}

/// Everything that can be reached from `seeds` without crossing a constrained edge.
class Flood {
 public:
  explicit Flood(const Triangulation& mesh) : mesh_(mesh), reached_(mesh.triangles.size(), false) {}

  void add(TriangleId seed) {
    if (reached_[seed]) return;
    reached_[seed] = true;
    stack_.push_back(seed);
    while (!stack_.empty()) {
      const TriangleId t = stack_.back();
      stack_.pop_back();
      order_.push_back(t);
      for (const HalfEdge h : mesh_.triangles[t].neighbor)
        if (!is_constrained(h) && !reached_[triangle_of(h)]) {
          reached_[triangle_of(h)] = true;
          stack_.push_back(triangle_of(h));
        }
    }
  }
  [[nodiscard]] bool reached(TriangleId t) const { return reached_[t]; }
  [[nodiscard]] const std::vector<TriangleId>& triangles() const { return order_; }

 private:
  const Triangulation& mesh_;
  IdVector<TriangleId, bool> reached_;
  std::vector<TriangleId> stack_;
  std::vector<TriangleId> order_;
};

void remove_outside(Triangulation& mesh, const Flood& outside) {
  for (const TriangleId t : outside.triangles()) {
    for (int i = 0; i < 3; ++i) {
      const HalfEdge g = mesh.twin(half_edge(t, i));
      if (!is_constrained(g)) continue;
      for (HalfEdge& half : mesh.subsegments[subsegment_of(g)].half)
        if (half == half_edge(t, i)) half = kNone;
    }
    mesh.remove_triangle(t);
  }
}

/// Keeps the roots (whole segments at this stage) that still bound a triangle. Returns the others.
std::vector<RootId> drop_unused_segments(Triangulation& mesh) {
  IdVector<SubsegmentId, Subsegment> subsegments;
  IdVector<RootId, RootSegment> roots;
  subsegments.reserve(mesh.roots.size());
  roots.reserve(mesh.roots.size());
  std::vector<RootId> dropped;
  for (const RootId r : ids_of(mesh.roots)) {
    RootSegment root = mesh.roots[r];
    Subsegment s = mesh.subsegments[root.tree];
    if (s.half[0] == kNone && s.half[1] == kNone) {
      dropped.push_back(r);
      continue;
    }
    const SubsegmentId kept = subsegments.next_id();
    for (const HalfEdge h : s.half)
      if (h != kNone) mesh.triangles[triangle_of(h)].neighbor[index_of(h)] = constrained(kept);
    s.root = roots.next_id();
    root.tree = kept;
    subsegments.push_back(s);
    roots.push_back(root);
  }
  mesh.subsegments.swap(subsegments);
  mesh.roots.swap(roots);
  return dropped;
}

std::vector<CarveReport::Meeting> label_regions(Triangulation& mesh, const std::vector<TriangleId>& seeds) {
  std::vector<CarveReport::Meeting> meetings;
  if (seeds.empty()) return meetings;
  mesh.region.resize(mesh.triangles.size(), 0);
  Flood flood(mesh);
  std::vector<std::pair<std::size_t, std::size_t>> areas(seeds.size());  // of each region, a part of flood.triangles()
  for (std::size_t r = 0; r < seeds.size(); ++r) {
    if (seeds[r] == kNone || !mesh.triangles[seeds[r]].alive()) continue;
    if (const std::uint16_t before = mesh.region[seeds[r]]; before != 0) {
      meetings.push_back({before - 1, static_cast<std::int32_t>(r)});
      areas[r] = areas[before - 1];
    } else {
      areas[r].first = flood.triangles().size();
      flood.add(seeds[r]);
      areas[r].second = flood.triangles().size();
    }
    for (std::size_t k = areas[r].first; k < areas[r].second; ++k)
      mesh.region[flood.triangles()[k]] = narrow<std::uint16_t>(r + 1, "number of regions");
  }
  return meetings;
}

[[noreturn]] void nothing_left(const Pslg& pslg, bool before_holes) {
  if (before_holes)
    throw Error("the segments enclose no area: the outer boundary is open or missing (" +
                std::to_string(pslg.segments.size()) + " segments); close the boundary");
  throw Error("the hole points remove the whole domain: each of them must lie inside a closed ring of segments");
}

/// Keeps the triangles that can be reached from an inner side, with that side's label; all others lie outside.
void keep_inner_sides(Triangulation& mesh, const std::vector<SegmentSides>& sides, std::size_t first_root) {
  Flood inside(mesh);
  IdVector<TriangleId, std::uint16_t> label(mesh.triangles.size(), 0);
  bool labeled = false;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const RootSegment& root = mesh.roots[static_cast<RootId>(first_root + i)];
    const auto& half = mesh.subsegments[root.tree].half;
    for (const auto& [edge, side] : {std::pair(half[0], sides[i].left), std::pair(half[1], sides[i].right)}) {
      if (side == kNone || inside.reached(triangle_of(edge))) continue;
      const std::size_t before = inside.triangles().size();
      inside.add(triangle_of(edge));
      for (std::size_t k = before; k < inside.triangles().size(); ++k)
        label[inside.triangles()[k]] = narrow<std::uint16_t>(side, "region label");
      labeled |= side != 0;
    }
  }
  Flood outside(mesh);
  for (const TriangleId t : ids_of(mesh.triangles))
    if (mesh.triangles[t].alive() && !inside.reached(t)) outside.add(t);
  remove_outside(mesh, outside);
  if (!labeled) return;
  mesh.region.resize(mesh.triangles.size(), 0);
  for (const TriangleId t : ids_of(label)) mesh.region[t] = label[t];
}

/// The triangle of each point. Points that follow each other along a Hilbert curve are close, and so are the walks.
std::vector<TriangleId> locate_all(const Triangulation& mesh, const std::vector<Point>& points) {
  std::vector<TriangleId> found(points.size(), kNone);
  TriangleId near{0};
  for (const std::size_t i : in_hilbert_order(points)) {
    found[i] = locate(mesh, points[i], near);
    if (found[i] != kNone) near = found[i];
  }
  return found;
}

}  // namespace

TriangleId locate(const Triangulation& mesh, const Point& p, TriangleId start) {
  TriangleId t = start;
  const std::size_t most = 4 * mesh.triangles.size() + 16;
  unsigned turn = 0;  // which edge is tried first; varied so that the walk does not go in circles
  for (std::size_t step = 0; step < most; ++step) {
    HalfEdge out = kNone;
    bool inside = true;
    turn = turn * 1664525u + 1013904223u;
    for (int k = 0; k < 3 && out == kNone; ++k) {
      const int i = static_cast<int>((static_cast<unsigned>(k) + (turn >> 16)) % 3);
      if (orient2d(mesh.corner(t, next(i)), mesh.corner(t, previous(i)), p) >= 0) continue;
      inside = false;
      out = mesh.across(half_edge(t, i));
    }
    if (inside) return t;
    if (out == kNone) break;
    t = triangle_of(out);
  }
  return search_all(mesh, p);
}

CarveReport carve(Triangulation& mesh, const Pslg& pslg, std::size_t first_root) {
  std::vector<Point> regions;
  for (const Pslg::Region& r : pslg.regions) regions.push_back(r.at);
  const std::vector<TriangleId> region_seeds = locate_all(mesh, regions), hole_seeds = locate_all(mesh, pslg.holes);

  Flood outside(mesh);
  for (const Subsegment& s : mesh.subsegments)
    if ((s.half[0] == kNone) != (s.half[1] == kNone))  // of the frame
      outside.add(triangle_of(s.half[0] == kNone ? s.half[1] : s.half[0]));
  const bool open = outside.triangles().size() == mesh.triangles.size();
  for (const TriangleId t : hole_seeds)
    if (t != kNone) outside.add(t);
  if (outside.triangles().size() == mesh.triangles.size()) nothing_left(pslg, open);
  remove_outside(mesh, outside);
  CarveReport report;
  for (const RootId r : drop_unused_segments(mesh))
    if (to_index(r) >= first_root) report.dropped.push_back(static_cast<std::int32_t>(to_index(r) - first_root));
  report.meetings = label_regions(mesh, region_seeds);
  return report;
}

void carve(Triangulation& mesh, const std::vector<SegmentSides>& sides, std::size_t first_root) {
  keep_inner_sides(mesh, sides, first_root);
  static_cast<void>(drop_unused_segments(mesh));
}

}  // namespace driftmesh
