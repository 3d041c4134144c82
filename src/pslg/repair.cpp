#include "driftmesh/repair.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/formatted.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/id_vector.hpp"
#include "geometry/box_tree.hpp"
#include "geometry/predicates.hpp"
#include "pslg/closeness.hpp"
#include "pslg/describe.hpp"
#include "pslg/enclosing_ring.hpp"
#include "pslg/planarize.hpp"
#include "pslg/polygons.hpp"
#include "pslg/segment_finder.hpp"

namespace driftmesh {
namespace {

bool usable(const Point& p) {
  return std::fabs(p.x) <= kMaxCoordinate && std::fabs(p.y) <= kMaxCoordinate;
}

/// So that the predicates are exact for all points that bisection makes of the input's.
Point on_grid(const Point& p) {
  return {rounded_to(p.x, kInputGrid), rounded_to(p.y, kInputGrid)};
}

void round_coordinates(Pslg& pslg, RepairReport& report) {
  for (std::size_t i = 0; i < pslg.points.size(); ++i) {
    const Point rounded = on_grid(pslg.points[i]);
    if (rounded == pslg.points[i]) continue;
    if (report.rounded_points.count++ < RepairItem::kMaxExamples)
      report.rounded_points.examples.push_back(vertex_name(pslg, static_cast<std::int32_t>(i), pslg.points[i]));
    pslg.points[i] = rounded;
  }
  for (Point& hole : pslg.holes) hole = on_grid(hole);
  for (Pslg::Region& region : pslg.regions) region.at = on_grid(region.at);
}

// Checks what readers guarantee, but programs that fill a Pslg may get wrong.
void check_values(const Pslg& pslg, const std::string& file) {
  const auto fail = [&](const std::string& what, const char* next) { throw InputError({file, 0}, what, next); };
  const std::size_t n = pslg.points.size();
  if (!pslg.point_markers.empty() && pslg.point_markers.size() != n)
    fail("there are " + std::to_string(pslg.point_markers.size()) + " markers for " + std::to_string(n) + " points",
         "give none or one for each");
  if (pslg.attributes_per_point < 0 || pslg.attributes.size() != n * pslg.attributes_per_point)
    fail("the attributes do not match the points", "give attributes_per_point values for each point");
  for (std::size_t i = 0; i < n; ++i)
    if (!usable(pslg.points[i]))
      fail(vertex_name(pslg, static_cast<std::int32_t>(i), pslg.points[i]) + " is outside the range of coordinates",
           "scale the input");
  for (std::size_t i = 0; i < pslg.segments.size(); ++i) {
    const Pslg::Segment& s = pslg.segments[i];
    if (to_index(s.a) >= n || to_index(s.b) >= n)
      fail(segment_name(pslg, static_cast<std::int32_t>(i)) + " names a vertex that does not exist",
           "vertices are numbered as the points are");
  }
}

/// The first edge of a ring that is no segment, if there is one.
std::optional<std::pair<std::int32_t, std::int32_t>> loose_edge_of(const Pslg::Ring& ring,
                                                                   const SegmentFinder& finder) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const std::int32_t from = ring[i], to = ring[i + 1 == ring.size() ? 0 : i + 1];
    if (from != to && finder.between(from, to) < 0) return std::pair(from, to);
  }
  return std::nullopt;
}

void check_polygons(const Pslg& pslg, const std::string& file) {
  if (pslg.polygons.empty()) return;
  const SegmentFinder finder(pslg);
  for (std::size_t p = 0; p < pslg.polygons.size(); ++p) {
    const Pslg::Polygon& polygon = pslg.polygons[p];
    const auto fail = [&](const std::string& what, const char* next) {
      throw InputError({file, 0}, polygon_name(pslg, p) + " " + what, next);
    };
    if (polygon.region < -1 || (polygon.region >= 0 && to_index(polygon.region) >= pslg.regions.size()))
      fail("names a region that does not exist", "regions are numbered from 0; -1 is none");
    for (const Pslg::Ring& ring : polygon.rings) {
      for (const std::int32_t corner : ring)
        if (to_index(corner) >= pslg.points.size())
          fail("has a ring that names a vertex that does not exist", "vertices are numbered as the points are");
      if (const auto edge = loose_edge_of(ring, finder))
        fail("has a ring with an edge that is no segment, from " +
                 vertex_name(pslg, edge->first, pslg.points[edge->first]) + " to " +
                 vertex_name(pslg, edge->second, pslg.points[edge->second]),
             "add it to the segments");
    }
  }
}

bool spans_plane(const std::vector<Point>& points) {
  const auto other = std::ranges::find_if(points, [&](const Point& p) { return p != points.front(); });
  return other != points.end() &&
         std::ranges::any_of(points, [&](const Point& p) { return orient2d(points.front(), *other, p) != 0; });
}

/// Throws InputError if snapping has left nothing that has an area of a domain whose box was `before`.
void check_snapped(const Pslg& pslg, const Box& before, const std::string& file, double snap) {
  if (spans_plane(pslg.points)) return;
  throw InputError({file, 0}, formatted("has no area left when all that is at most {} apart is joined", snap),
                   formatted("snap by a smaller distance: the domain is {:.6g} by {:.6g}", before.high.x - before.low.x,
                             before.high.y - before.low.y));
}

void check_spans_plane(const Pslg& pslg, const std::string& file) {
  if (spans_plane(pslg.points)) return;
  if (pslg.points.size() < 3)
    throw InputError({file, 0}, "has " + std::to_string(pslg.points.size()) + " different vertices",
                     "a mesh needs at least three");
  throw InputError({file, 0}, "all vertices lie on one line", "a mesh needs an area");
}

/// Locates seed points among the segments of a planar graph.
class SeedCheck {
 public:
  explicit SeedCheck(const Pslg& pslg) : pslg_(pslg), tree_(boxes(pslg)) {
    for (const Point& p : pslg.points) bounds_.extend(p);
  }

  /// The index of a segment that `p` lies on, or -1.
  [[nodiscard]] std::int32_t segment_at(const Point& p) const {
    std::int32_t found = -1;
    visit_until(Box::around(p, p), [&](std::int32_t i, const Point& a, const Point& b) {
      if (orient2d(a, b, p) == 0) found = i;
      return found >= 0;
    });
    return found;
  }

  /// Whether nothing lies between `p` and infinity in one of the four axis directions, so that no boundary encloses it.
  /// Not every point outside is found: one deep in an inlet may be hidden in all four.
  [[nodiscard]] bool certainly_outside(const Point& p) const {
    if (!bounds_.contains(p)) return true;
    return sees_nothing(p, {bounds_.high.x, p.y}) || sees_nothing(p, {bounds_.low.x, p.y}) ||
           sees_nothing(p, {p.x, bounds_.high.y}) || sees_nothing(p, {p.x, bounds_.low.y});
  }

 private:
  static std::vector<Box> boxes(const Pslg& pslg) {
    std::vector<Box> all;
    for (const Pslg::Segment& s : pslg.segments) all.push_back(Box::around(pslg.points[s.a], pslg.points[s.b]));
    return all;
  }

  /// Visits the segments whose boxes overlap `place` until one makes `visit` return true.
  template <class Visit>
  void visit_until(const Box& place, Visit visit) const {
    bool done = false;
    tree_.search([&](const Box& box) { return !done && box.overlaps(place); },
                 [&](std::int32_t i) {
                   const Pslg::Segment& s = pslg_.segments[i];
                   done = visit(i, pslg_.points[s.a], pslg_.points[s.b]);
                 });
  }

  // The ray meets a segment whose box it meets unless both ends of the ray lie on the same side of the segment.
  [[nodiscard]] bool sees_nothing(const Point& p, const Point& far) const {
    bool nothing = true;
    visit_until(Box::around(p, far), [&](std::int32_t, const Point& a, const Point& b) {
      const double side = orient2d(a, b, p), far_side = orient2d(a, b, far);
      nothing = (side > 0 && far_side > 0) || (side < 0 && far_side < 0);
      return !nothing;
    });
    return nothing;
  }

  const Pslg& pslg_;
  BoxTree tree_;
  Box bounds_;
};

void check_seed(const SeedCheck& check, const Point& seed, const std::string& name, const std::string& file,
                const char* effect, RepairReport& report) {
  if (!usable(seed)) throw InputError({file, 0}, name + " is outside the range of coordinates", "correct it");
  if (check.segment_at(seed) >= 0)
    throw InputError({file, 0}, name + " lies on a segment", "move it to the intended side");
  if (check.certainly_outside(seed)) report.warnings.push_back(name + " lies outside the domain; " + effect);
}

void check_seeds(const Pslg& pslg, const std::string& file, RepairReport& report) {
  if (pslg.holes.empty() && pslg.regions.empty()) return;
  const SeedCheck check(pslg);
  std::size_t number = 0;
  for (const Point& hole : pslg.holes)
    check_seed(check, hole, "hole " + std::to_string(++number) + " at " + coordinates(hole), file, "it removes nothing",
               report);
  const std::vector<bool> named = regions_of_polygons(pslg);
  for (std::size_t r = 0; r < named.size(); ++r)
    if (const Point& at = pslg.regions[r].at; !named[r])
      check_seed(check, at, "region " + std::to_string(r + 1) + " at " + coordinates(at), file, "it has no effect",
                 report);
}

/// What encloses the seeds of holes and regions before snapping, and what does afterward.
class SeedWatch {
 public:
  SeedWatch(const Pslg& pslg, const std::string& file) {
    if (pslg.holes.empty() && pslg.regions.empty()) return;
    Pslg plain = pslg;
    RepairReport ignored;
    planarize(plain, file, {}, ignored);
    const EnclosingRings rings(plain);
    for (const Point& hole : plain.holes) holes_.push_back(rings.around(hole));
    const std::vector<bool> named = regions_of_polygons(plain);
    for (std::size_t r = 0; r < named.size(); ++r)
      regions_.push_back(named[r] ? std::nullopt : rings.around(plain.regions[r].at));
  }

  /// Drops the seeds whose areas are gone: what encloses them now is larger.
  void drop_lost(Pslg& pslg, RepairReport& report) const {
    if (pslg.holes.empty() && pslg.regions.empty()) return;
    const EnclosingRings rings(pslg);
    const auto at_hole = [](const Point& hole) { return hole; };
    const auto at_region = [](const Pslg::Region& region) { return region.at; };
    keep_found(rings, holes_, pslg.holes, at_hole, "hole ", report);
    keep_found(rings, regions_, pslg.regions, at_region, "region ", report);
  }

 private:
  using Ring = std::optional<EnclosingRing>;

  template <class Seed, class At>
  static void keep_found(const EnclosingRings& rings, const std::vector<Ring>& before, std::vector<Seed>& seeds, At at,
                         const char* kind, RepairReport& report) {
    std::vector<Seed> kept;
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      const Ring now = rings.around(at(seeds[i]));
      const std::string name = kind + std::to_string(i + 1) + " at " + coordinates(at(seeds[i]));
      const double slack = before[i] ? 2 * report.snap * before[i]->length : 0;
      if (before[i] && (!now || now->area > before[i]->area + slack)) {
        report.warnings.push_back(name +
                                  " is left out: snapping has left nothing of its area, or moved a segment past it");
        continue;
      }
      if (before[i] && now->area < before[i]->area - slack)
        report.warnings.push_back(name + " has lost parts of its area that snapping has cut off");
      kept.push_back(seeds[i]);
    }
    seeds = std::move(kept);
  }

  std::vector<Ring> holes_, regions_;
};

void make_planar(Pslg& pslg, const std::string& file, const RepairOptions& options, RepairReport& report) {
  if (options.snap == 0) return planarize(pslg, file, options, report);
  const SeedWatch seeds(pslg, file);
  planarize(pslg, file, options, report);
  seeds.drop_lost(pslg, report);
}

}  // namespace

RepairReport repair(Pslg& pslg, const std::string& file, const RepairOptions& options) {
  if (!(options.snap >= 0 && std::isfinite(options.snap)))
    throw Error("the length by which to snap is negative or not finite");
  check_values(pslg, file);
  check_polygons(pslg, file);
  if (options.hull && !pslg.polygons.empty())
    throw InputError({file, 0}, "has polygons, which are the domain, and a convex hull would be another",
                     "leave out the hull, or give the outline as lines");
  RepairReport report;
  report.snap = options.snap;
  round_coordinates(pslg, report);
  std::optional<Box> snapped;  // the box of a domain that has an area
  if (options.snap > 0 && spans_plane(pslg.points)) snapped = Box::of(pslg.points);
  make_planar(pslg, file, options, report);
  if (snapped) check_snapped(pslg, *snapped, file, options.snap);
  check_spans_plane(pslg, file);
  check_seeds(pslg, file, report);
  return report;
}

}  // namespace driftmesh
