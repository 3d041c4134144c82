#include "mesh/carve.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/disjoint_sets.hpp"
#include "base/narrow.hpp"
#include "driftmesh/error.hpp"
#include "geometry/hilbert_sort.hpp"
#include "geometry/midpoint.hpp"
#include "geometry/predicates.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/areas.hpp"
#include "pslg/open_boundary.hpp"
#include "pslg/polygons.hpp"

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
  std::vector<std::pair<std::size_t, std::size_t>> areas(seeds.size());  // for each region, a part of flood.triangles()
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
  if (before_holes && !pslg.polygons.empty())
    throw Error("the polygons cover no area (" + std::to_string(pslg.polygons.size()) +
                " polygons); correct rings that are lines or empty, and holes that take all of their polygons");
  if (before_holes) throw Error(describe_open_boundary(pslg));
  const std::string gap = describe_gap(pslg, find_open_boundary(pslg).open_ends);
  throw Error("the hole points remove the whole domain: each of them must lie inside a closed ring of segments" +
              (gap.empty() ? "" : ", but some chain of segments is open: " + gap));
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
      DM_ASSERT(side == kNone || edge != kNone);  // a segment that comes twice has its triangles once
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

/// All that can be reached from the border of the box.
void add_surroundings(const Triangulation& mesh, Flood& outside) {
  for (const Subsegment& s : mesh.subsegments)
    if ((s.half[0] == kNone) != (s.half[1] == kNone))  // on the frame
      outside.add(triangle_of(s.half[0] == kNone ? s.half[1] : s.half[0]));
}

/// Carving by what polygons cover.
class PolygonCarving {
 public:
  /// Before anything is removed. The segments are the roots from `first_root` on, those before are the frame's.
  PolygonCarving(const Triangulation& mesh, const Pslg& pslg, std::size_t first_root)
      : mesh_(mesh), pslg_(pslg), areas_(mesh) {
    const auto& frame = mesh.subsegments[mesh.roots[RootId{0}].tree].half;
    outside_ = areas_.of(frame[0] == kNone ? frame[1] : frame[0]);
    for (std::size_t i = 0; i < pslg.segments.size(); ++i)
      walls_.push_back(wall_of(pslg.segments[i], mesh.roots[static_cast<RootId>(first_root + i)]));
    cover_ = cover_by_polygons(pslg, walls_, areas_.count(), outside_);
  }

  void add_uncovered(Flood& outside) const {
    for (const AreaId area : areas_.ids())
      if (!cover_.inside[area]) outside.add(areas_.largest(area));
  }

  /// Reports what is outside in the end, before it is removed.
  void report(const Flood& outside, CarveReport& report) const {
    report.holes = holes(outside);
    for (const PolygonFlaw& flaw : cover_.flaws) report.flaws.push_back({flaw, place_of(flaw)});
  }

  /// Labels the triangles that have no label yet.
  void label(Triangulation& mesh) const {
    if (std::ranges::all_of(cover_.region, [](std::int32_t region) { return region < 0; })) return;
    mesh.region.resize(mesh.triangles.size(), 0);
    for (const TriangleId t : ids_of(mesh.triangles))
      if (mesh.triangles[t].alive() && mesh.region[t] == 0)
        mesh.region[t] = narrow<std::uint16_t>(cover_.region[areas_.of(t)] + 1, "number of regions");
  }

 private:
  [[nodiscard]] Wall wall_of(const Pslg::Segment& segment, const RootSegment& root) const {
    const auto& half = mesh_.subsegments[root.tree].half;
    if (half[0] == kNone) return {kNone, kNone};
    const bool along = mesh_.origin[mesh_.edge_start(half[0])] == segment.a;
    return {areas_.of(half[along ? 0 : 1]), areas_.of(half[along ? 1 : 0])};
  }

  [[nodiscard]] std::optional<Point> place_of(const PolygonFlaw& flaw) const {
    if (flaw.area != kNone) return center_of(mesh_, areas_.largest(flaw.area));
    if (flaw.segment == kNone) {
      for (const Pslg::Ring& ring : pslg_.polygons[flaw.polygon].rings)
        if (!ring.empty()) return pslg_.points[ring[0]];
      return std::nullopt;
    }
    const Pslg::Segment& s = pslg_.segments[flaw.segment];
    return midpoint(pslg_.points[s.a], pslg_.points[s.b]);
  }

  /// A point in each group of areas outside that no segment of the domain separates, unless it lies around everything.
  [[nodiscard]] std::vector<Point> holes(const Flood& outside) const {
    const auto removed = [&](AreaId area) { return outside.reached(areas_.largest(area)); };
    DisjointSets<AreaId> groups(areas_.count());
    for (const Wall& wall : walls_)
      if (wall.left != kNone && removed(wall.left) && removed(wall.right)) groups.join(wall.left, wall.right);
    IdVector<AreaId, TriangleId> largest(areas_.count(), kNone);
    for (const AreaId area : areas_.ids()) {
      TriangleId& known = largest[groups.find(area)];
      if (known == kNone || size(areas_.largest(area)) > size(known)) known = areas_.largest(area);
    }
    std::vector<Point> points;
    for (const AreaId area : areas_.ids())
      if (groups.find(area) == area && removed(area) && area != groups.find(outside_))
        points.push_back(center_of(mesh_, largest[area]));
    return points;
  }

  [[nodiscard]] double size(TriangleId t) const {
    return signed_area(mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2));
  }

  const Triangulation& mesh_;
  const Pslg& pslg_;
  Areas areas_;
  AreaId outside_;
  std::vector<Wall> walls_;
  PolygonCover cover_;
};

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

/// The triangle of the seed of each region; kNone for those of polygons, which have none.
std::vector<TriangleId> locate_regions(const Triangulation& mesh, const Pslg& pslg) {
  const std::vector<bool> named = regions_of_polygons(pslg);
  std::vector<Point> seeds;
  for (std::size_t r = 0; r < named.size(); ++r)
    if (!named[r]) seeds.push_back(pslg.regions[r].at);
  const std::vector<TriangleId> located = locate_all(mesh, seeds);
  std::vector<TriangleId> found;
  auto next = located.begin();
  for (const bool by_polygon : named) found.push_back(by_polygon ? TriangleId{kNone} : *next++);
  return found;
}

}  // namespace

TriangleId locate(const Triangulation& mesh, const Point& p, TriangleId start) {
  TriangleId t = start;
  const std::size_t most = 4 * mesh.triangles.size() + 16;
  unsigned turn = 0;  // the edge tried first; varied so that the walk does not go in circles
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
  const std::vector<TriangleId> region_seeds = locate_regions(mesh, pslg), hole_seeds = locate_all(mesh, pslg.holes);
  std::optional<PolygonCarving> polygons;
  if (!pslg.polygons.empty()) polygons.emplace(mesh, pslg, first_root);

  Flood outside(mesh);
  if (polygons)
    polygons->add_uncovered(outside);
  else
    add_surroundings(mesh, outside);
  const bool open = outside.triangles().size() == mesh.triangles.size();
  for (const TriangleId t : hole_seeds)
    if (t != kNone) outside.add(t);
  if (outside.triangles().size() == mesh.triangles.size()) nothing_left(pslg, open);
  CarveReport report;
  if (polygons) polygons->report(outside, report);
  remove_outside(mesh, outside);
  for (const RootId r : drop_unused_segments(mesh))
    if (to_index(r) >= first_root) report.dropped.push_back(static_cast<std::int32_t>(to_index(r) - first_root));
  report.meetings = label_regions(mesh, region_seeds);
  if (!polygons) return report;
  polygons->label(mesh);
  const std::vector<bool> on_ring = segments_of_rings(pslg);
  std::erase_if(report.dropped, [&](std::int32_t s) { return on_ring[s]; });
  return report;
}

void carve(Triangulation& mesh, const std::vector<SegmentSides>& sides, std::size_t first_root) {
  keep_inner_sides(mesh, sides, first_root);
  static_cast<void>(drop_unused_segments(mesh));
}

}  // namespace driftmesh
