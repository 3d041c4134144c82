#include "driftmesh/simplify.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <queue>
#include <unordered_set>
#include <utility>

#include "base/formatted.hpp"
#include "driftmesh/error.hpp"
#include "geometry/box_tree.hpp"
#include "geometry/polygon.hpp"
#include "geometry/predicates.hpp"
#include "geometry/segment_geometry.hpp"
#include "pslg/keep_points.hpp"
#include "pslg/pair_key.hpp"
#include "pslg/polygons.hpp"
#include "pslg/polylines.hpp"

namespace driftmesh {
namespace {

/// Fraction of the tolerance: shortcuts keep this distance from other points.
constexpr double kClearance = 0.25;
/// How much of a distance that was smaller is kept: if all of it, a point a meter from the end of a line stays, since
/// without it the line comes closer to something by a millimeter.
constexpr double kKept = 0.9;
/// The cosine of 60 degrees: corners sharper than that cost small triangles.
constexpr double kSharp = 0.5;

/// Cosine of the angle at v.
double cosine(const Point& a, const Point& v, const Point& b) {
  const double ax = a.x - v.x, ay = a.y - v.y, bx = b.x - v.x, by = b.y - v.y;
  return (ax * bx + ay * by) / std::sqrt((ax * ax + ay * ay) * (bx * bx + by * by));
}

/// The points of the lines, of the rest, and the seeds, to be found by their places.
class Obstacles {
 public:
  explicit Obstacles(const Pslg& pslg)
      : places_(pslg.points), seeds_begin_(static_cast<std::int32_t>(pslg.points.size())) {
    places_.insert(places_.end(), pslg.holes.begin(), pslg.holes.end());
    const std::vector<bool> named = regions_of_polygons(pslg);
    for (std::size_t r = 0; r < named.size(); ++r)
      if (!named[r]) places_.push_back(pslg.regions[r].at);
    std::vector<Box> boxes;
    for (const Point& p : places_) boxes.push_back({p, p});
    tree_ = BoxTree(boxes);
    there_.assign(places_.size(), true);
  }

  [[nodiscard]] const Point& place(std::int32_t i) const { return places_[i]; }
  [[nodiscard]] bool there(std::int32_t i) const { return there_[i]; }
  [[nodiscard]] bool is_seed(std::int32_t i) const { return i >= seeds_begin_; }
  [[nodiscard]] std::int32_t seeds_begin() const { return seeds_begin_; }
  void remove(std::int32_t i) { there_[i] = false; }

  /// Calls visit(i) for everything that is there in the box.
  template <class Visit>
  void visit_in(const Box& box, const Visit& visit) const {
    tree_.search([&](const Box& b) { return b.overlaps(box); },
                 [&](std::int32_t i) {
                   if (there_[i]) visit(i);
                 });
  }
  /// Whether anything that is there, in the box, has the property.
  template <class Property>
  [[nodiscard]] bool any_in(const Box& box, const Property& property) const {
    bool found = false;
    tree_.search([&](const Box& b) { return !found && b.overlaps(box); },
                 [&](std::int32_t i) { found = found || (there_[i] && property(i)); });
    return found;
  }

 private:
  std::vector<Point> places_;
  std::int32_t seeds_begin_;
  BoxTree tree_;
  std::vector<bool> there_;
};

// ---- Small rings ----

PolygonRing ring_of(const Polyline& line, const Pslg& pslg) {
  PolygonRing ring;
  for (const std::int32_t p : line.points) ring.push_back(pslg.points[p]);
  return ring;
}

/// Marks the closed lines that fit into a square of this side as dropped, with their points and all seeds inside.
class SmallRings {
 public:
  SmallRings(const Pslg& pslg, const std::vector<Polyline>& lines, double side, Obstacles& obstacles)
      : pslg_(pslg), obstacles_(obstacles), dropped_(lines.size(), false), small_(pslg.points.size()) {
    std::vector<std::size_t> small;
    for (std::size_t i = 0; i < lines.size(); ++i)
      if (const Box box = box_of(lines[i]);
          lines[i].closed && box.high.x - box.low.x <= side && box.high.y - box.low.y <= side)
        small.push_back(i);
    for (const std::size_t i : small)
      for (const std::int32_t p : lines[i].points) small_[p] = true;
    for (const std::size_t i : small) dropped_[i] = holds_only_small(lines[i]);
    for (const std::size_t i : small)
      if (dropped_[i]) drop(lines[i]);
  }

  [[nodiscard]] const std::vector<bool>& dropped() const { return dropped_; }

 private:
  [[nodiscard]] Box box_of(const Polyline& line) const {
    Box box;
    for (const std::int32_t p : line.points) box.extend(pslg_.points[p]);
    return box;
  }

  /// Calls visit(i) for everything inside a closed line.
  template <class Visit>
  void visit_inside(const Polyline& line, const Visit& visit) const {
    const PolygonRing ring = ring_of(line, pslg_);
    const PolygonRing* rings[] = {&ring};
    obstacles_.visit_in(box_of(line), [&](std::int32_t i) {
      if (is_inside(rings, obstacles_.place(i))) visit(i);
    });
  }

  /// Then all of these are small rings themselves, which hold only small ones.
  [[nodiscard]] bool holds_only_small(const Polyline& line) const {
    bool only = true;
    visit_inside(line, [&](std::int32_t i) { only = only && (obstacles_.is_seed(i) || small_[i]); });
    return only;
  }

  void drop(const Polyline& line) {
    std::vector<std::int32_t> seeds;
    visit_inside(line, [&](std::int32_t i) {
      if (obstacles_.is_seed(i)) seeds.push_back(i);
    });
    for (const std::int32_t seed : seeds) obstacles_.remove(seed);
    for (const std::int32_t p : line.points) obstacles_.remove(p);
  }

  const Pslg& pslg_;
  Obstacles& obstacles_;
  std::vector<bool> dropped_;
  std::vector<bool> small_;  // points of small rings
};

// ---- Points of lines ----

/// Removes points of all lines together, those with the smallest triangles first.
class Thinning {
 public:
  Thinning(const Pslg& pslg, const std::vector<Polyline>& lines, const std::vector<bool>& dropped, double tolerance,
           Obstacles& obstacles)
      : pslg_(pslg), tolerance_(tolerance), obstacles_(obstacles) {
    for (std::size_t i = 0; i < lines.size(); ++i)
      if (!dropped[i]) add(lines[i]);
    for (std::size_t i = 0; i < nodes_.size(); ++i) offer(static_cast<std::int32_t>(i));
  }

  /// The points that were removed.
  std::int64_t thin() {
    std::int64_t all = 0;
    for (std::int64_t removed = -1; removed != 0; all += removed) {
      removed = 0;
      for (; !queue_.empty(); queue_.pop()) removed += consider(queue_.top()) ? 1 : 0;
      if (removed == 0) break;
      for (std::size_t i = 0; i < nodes_.size(); ++i) offer(static_cast<std::int32_t>(i));
    }
    return all;
  }

  /// The segments that are left, each with the place of the first one that it replaces.
  [[nodiscard]] std::vector<std::pair<std::int32_t, Pslg::Segment>> segments() const {
    std::vector<std::pair<std::int32_t, Pslg::Segment>> segments;
    for (const Node& node : nodes_) {
      if (node.removed || node.segment < 0) continue;
      Pslg::Segment s = pslg_.segments[node.segment];
      const std::int32_t end = nodes_[node.next].point;
      const bool along = s.a == node.point;
      s.a = along ? node.point : end;
      s.b = along ? end : node.point;
      std::int32_t first = node.segment;
      for (std::int32_t i = node.following; i != node.next; i = nodes_[i].following)
        first = std::min(first, nodes_[i].segment);
      segments.emplace_back(first, s);
    }
    std::ranges::sort(segments, {}, [](const auto& s) { return s.first; });
    return segments;
  }

 private:
  /// A point in its place on a line.
  struct Node {
    std::int32_t point;
    std::int32_t segment;         // number in the input of the segment to the following point; -1 at the end of a line
    std::int32_t previous, next;  // among those that are left
    std::int32_t following;       // next in the input
    std::int32_t version = 0;     // grows when its neighbors change
    bool stays = false;
    bool removed = false;
  };
  struct Offer {
    double area;
    std::int32_t node, version;
    bool operator>(const Offer& o) const { return area != o.area ? area > o.area : node > o.node; }
  };

  void add(const Polyline& line) {
    const auto first = static_cast<std::int32_t>(nodes_.size());
    const auto count = static_cast<std::int32_t>(line.points.size());
    for (std::int32_t i = 0; i < count; ++i) {
      const bool last = i + 1 == count;
      const std::int32_t next = last ? (line.closed ? first : -1) : first + i + 1;
      const std::int32_t previous = i == 0 ? (line.closed ? first + count - 1 : -1) : first + i - 1;
      nodes_.push_back({line.points[i], next < 0 ? -1 : line.segments[i], previous, next, next});
      nodes_.back().stays = !line.closed && (i == 0 || last);
    }
    for (std::int32_t i = first; i < first + count; ++i)
      if (nodes_[i].next >= 0) joined_.insert(pair_key(nodes_[i].point, nodes_[nodes_[i].next].point));
  }

  [[nodiscard]] const Point& at(std::int32_t node) const { return pslg_.points[nodes_[node].point]; }

  void offer(std::int32_t i) {
    const Node& node = nodes_[i];
    if (node.stays || node.removed) return;
    queue_.push({std::abs(orient2d(at(node.previous), at(i), at(node.next))), i, node.version});
  }

  bool consider(Offer offered) {
    const Node& node = nodes_[offered.node];
    if (node.removed || node.version != offered.version || !may_go(offered.node)) return false;
    remove(offered.node);
    return true;
  }

  [[nodiscard]] bool may_go(std::int32_t i) const {
    const std::int32_t from = nodes_[i].previous, to = nodes_[i].next;
    const std::int32_t a = nodes_[from].point, b = nodes_[to].point;
    return a != b && !joined_.contains(pair_key(a, b)) && keeps_blunt(nodes_[from].previous, from, i, to) &&
           keeps_blunt(nodes_[to].next, to, i, from) && is_close(from, to) && is_free(from, i, to);
  }

  /// Whether the line, coming from `before`, turns no sharper at a node if it goes on to `after` instead of to `now`,
  /// or not sharply.
  [[nodiscard]] bool keeps_blunt(std::int32_t before, std::int32_t node, std::int32_t now, std::int32_t after) const {
    if (before < 0) return true;
    return cosine(at(before), at(node), at(after)) <= std::max(kSharp, cosine(at(before), at(node), at(now)));
  }

  /// Whether all points of the input between two nodes are close to the segment that would join them.
  [[nodiscard]] bool is_close(std::int32_t from, std::int32_t to) const {
    const double most = tolerance_ * tolerance_;
    for (std::int32_t i = nodes_[from].following; i != to; i = nodes_[i].following)
      if (squared_distance_to_segment(at(i), at(from), at(to)) > most) return false;
    return true;
  }

  /// The square of the distance to the input's line between two nodes.
  [[nodiscard]] double squared_distance_to_input(const Point& p, std::int32_t from, std::int32_t to) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::int32_t i = from; i != to; i = nodes_[i].following)
      least = std::min(least, squared_distance_to_segment(p, at(i), at(nodes_[i].following)));
    return least;
  }

  /// Whether nothing lies in the triangle of a node and its neighbors or on its sides, and nothing comes close to the
  /// new side that was not about as close to the input's line.
  [[nodiscard]] bool is_free(std::int32_t from, std::int32_t node, std::int32_t to) const {
    const std::int32_t a = nodes_[from].point, v = nodes_[node].point, b = nodes_[to].point;
    const Point &pa = pslg_.points[a], &pv = pslg_.points[v], &pb = pslg_.points[b];
    const double clear = kClearance * tolerance_, square = clear * clear;
    Box box = Box::around(pa, pb, clear);
    box.extend(pv);
    const double turn = orient2d(pa, pv, pb);
    return !obstacles_.any_in(box, [&](std::int32_t i) {
      if (i == a || i == v || i == b) return false;
      const Point& p = obstacles_.place(i);
      const auto on_side = [&](const Point& start, const Point& end) { return turn * orient2d(start, end, p) >= 0; };
      if (turn != 0 && on_side(pa, pv) && on_side(pv, pb) && on_side(pb, pa)) return true;
      const double distance = squared_distance_to_segment(p, pa, pb);
      return distance < square && distance < kKept * kKept * squared_distance_to_input(p, from, to);
    });
  }

  void remove(std::int32_t i) {
    Node& node = nodes_[i];
    const std::int32_t from = node.previous, to = node.next;
    joined_.erase(pair_key(nodes_[from].point, node.point));
    joined_.erase(pair_key(node.point, nodes_[to].point));
    joined_.insert(pair_key(nodes_[from].point, nodes_[to].point));
    nodes_[from].next = to;
    nodes_[to].previous = from;
    node.removed = true;
    obstacles_.remove(node.point);
    for (const std::int32_t neighbor : {from, to}) {
      ++nodes_[neighbor].version;
      offer(neighbor);
    }
  }

  const Pslg& pslg_;
  double tolerance_;
  Obstacles& obstacles_;
  std::vector<Node> nodes_;
  std::unordered_set<std::uint64_t> joined_;  // pairs of points
  std::priority_queue<Offer, std::vector<Offer>, std::greater<>> queue_;
};

/// Drops rings that have no corner left, and polygons without a first ring.
void keep_rings(Pslg& pslg) {
  for (Pslg::Polygon& polygon : pslg.polygons) {
    const bool has_outer = !polygon.rings.empty() && !polygon.rings[0].empty();
    std::erase_if(polygon.rings, [&](const Pslg::Ring& ring) { return !has_outer || ring.empty(); });
  }
  std::erase_if(pslg.polygons, [](const Pslg::Polygon& polygon) { return polygon.rings.empty(); });
}

/// Keeps the regions that polygons still name, and those of the seeds that are there.
void keep_regions(Pslg& pslg, const std::vector<bool>& named_before, const Obstacles& obstacles, std::int32_t seed) {
  const std::vector<bool> named = regions_of_polygons(pslg);
  std::vector<Pslg::Region> kept;
  std::vector<std::int32_t> number;  // index of each region among those
  for (std::size_t r = 0; r < named.size(); ++r) {
    number.push_back(static_cast<std::int32_t>(kept.size()));
    if (named_before[r] ? named[r] : obstacles.there(seed++)) kept.push_back(pslg.regions[r]);
  }
  for (Pslg::Polygon& polygon : pslg.polygons)
    if (polygon.region >= 0) polygon.region = number[polygon.region];
  pslg.regions = std::move(kept);
}

/// Keeps the points, polygons, holes and regions that are there, and these segments.
std::vector<std::int32_t> keep(Pslg& pslg, const Obstacles& obstacles,
                               const std::vector<std::pair<std::int32_t, Pslg::Segment>>& segments) {
  std::vector<bool> gone;
  for (std::int32_t p = 0; p < obstacles.seeds_begin(); ++p) gone.push_back(!obstacles.there(p));
  pslg.segments.clear();
  for (const auto& [first, s] : segments) pslg.segments.push_back(s);
  const std::vector<bool> named = regions_of_polygons(pslg);
  std::vector<std::int32_t> kept = keep_points(pslg, gone);
  std::int32_t seed = obstacles.seeds_begin();
  std::erase_if(pslg.holes, [&](const Point&) { return !obstacles.there(seed++); });
  keep_rings(pslg);
  keep_regions(pslg, named, obstacles, seed);
  return kept;
}

}  // namespace

SimplifyReport simplify(Pslg& pslg, double tolerance, const std::string& file) {
  if (!(tolerance >= 0) || !std::isfinite(tolerance))
    throw Error(formatted("the tolerance of simplification must be a length, but is {}", tolerance));
  SimplifyReport report;
  const std::vector<Polyline> lines = polylines_of(pslg);
  Obstacles obstacles(pslg);
  const std::vector<bool> dropped = SmallRings(pslg, lines, tolerance, obstacles).dropped();
  report.rings = std::ranges::count(dropped, true);
  if (!lines.empty() && report.rings == static_cast<std::int64_t>(lines.size()))
    throw InputError({file, 0}, "all of it fits into a square of the length by which it may be simplified",
                     "give a smaller length");
  Thinning thinning(pslg, lines, dropped, tolerance, obstacles);
  report.points = thinning.thin();
  report.original_point = keep(pslg, obstacles, thinning.segments());
  return report;
}

}  // namespace driftmesh
