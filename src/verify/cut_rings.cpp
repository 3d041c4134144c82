#include "verify/cut_rings.hpp"

#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "driftmesh/id_vector.hpp"
#include "geometry/box_tree.hpp"
#include "geometry/predicates.hpp"
#include "verify/extended.hpp"
#include "verify/point_index.hpp"

namespace driftmesh {
namespace {

constexpr int kMostRounds = 30;

using Ends = std::pair<std::int32_t, std::int32_t>;  // ascending

/// The edges of all rings, ascending and each once.
std::vector<Ends> edges_of(const Pslg& rings) {
  std::vector<Ends> edges;
  for (const Pslg::Polygon& polygon : rings.polygons)
    for (const Pslg::Ring& ring : polygon.rings)
      for (std::size_t i = 0; i < ring.size(); ++i)
        edges.emplace_back(std::minmax(ring[i], ring[(i + 1) % ring.size()]));
  std::ranges::sort(edges);
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

/// Points that are in no ring are left out, and segments become those of the rings.
void set_segments(Pslg& rings) {
  std::vector<std::int32_t> place(rings.points.size(), kNone);
  std::vector<Point> used;
  for (Pslg::Polygon& polygon : rings.polygons)
    for (Pslg::Ring& ring : polygon.rings)
      for (std::int32_t& corner : ring) {
        if (place[corner] == kNone) {
          place[corner] = static_cast<std::int32_t>(used.size());
          used.push_back(rings.points[corner]);
        }
        corner = place[corner];
      }
  rings.points = std::move(used);
  rings.segments.clear();
  for (const auto& [a, b] : edges_of(rings)) rings.segments.push_back({a, b, 0});
}

/// Cuts in rounds, as rounded places of crossings may make new ones.
class RingCutter {
 public:
  explicit RingCutter(Pslg rings) : result_(std::move(rings)) {}

  std::optional<Pslg> run() {
    for (int round = 0; round < kMostRounds; ++round) {
      edges_ = edges_of(result_);
      cuts_.assign(edges_.size(), {});
      if (!find_cuts()) {
        set_segments(result_);
        return std::move(result_);
      }
      cut();
    }
    return std::nullopt;
  }

 private:
  [[nodiscard]] const Point& at(std::int32_t point) const { return result_.points[point]; }

  // ---- A round -------------------------------------------------------------------------------------------------

  bool find_cuts() {
    std::vector<Box> boxes;
    boxes.reserve(edges_.size());
    for (const auto& [a, b] : edges_) boxes.push_back(Box::around(at(a), at(b)));
    bool any = false;
    BoxTree(boxes).visit_overlapping([&](std::int32_t e, std::int32_t f) {
      if (meet(e, f)) any = true;
    });
    return any;
  }

  /// Notes where two edges are to be cut; false if they need not be.
  bool meet(std::int32_t e, std::int32_t f) {
    bool at_ends = false;
    for (const auto& [edge, other] : {std::pair(e, f), std::pair(f, e)})
      for (const auto end : {edges_[other].first, edges_[other].second})
        if (cut_at_end(edge, end)) at_ends = true;
    return at_ends || cut_at_crossing(e, f);
  }

  bool cut_at_end(std::int32_t edge, std::int32_t point) {
    const auto& [a, b] = edges_[edge];
    if (point == a || point == b || !Box::around(at(a), at(b)).contains(at(point))) return false;
    if (orient2d(at(a), at(b), at(point)) != 0) return false;
    cuts_[edge].push_back(point);
    return true;
  }

  bool cut_at_crossing(std::int32_t e, std::int32_t f) {
    const Point &a = at(edges_[e].first), &b = at(edges_[e].second), &c = at(edges_[f].first),
                &d = at(edges_[f].second);
    const auto apart = [](double u, double v) { return (u < 0 && v > 0) || (u > 0 && v < 0); };
    if (!apart(orient2d(a, b, c), orient2d(a, b, d)) || !apart(orient2d(c, d, a), orient2d(c, d, b))) return false;
    const std::int32_t point = point_at(crossing(a, b, c, d));
    for (const std::int32_t edge : {e, f})
      if (point != edges_[edge].first && point != edges_[edge].second) cuts_[edge].push_back(point);
    return true;
  }

  static Point crossing(const Point& a, const Point& b, const Point& c, const Point& d) {
    const long double from = cross_extended(c, d, a), to = cross_extended(c, d, b);
    const long double t = from / (from - to);
    const Box box = Box::around(a, b), other = Box::around(c, d);
    const auto within = [](long double x, double low, double high) {
      return std::min(std::max(static_cast<double>(x), low), high);
    };
    return {within(a.x + t * (static_cast<long double>(b.x) - a.x), std::max(box.low.x, other.low.x),
                   std::min(box.high.x, other.high.x)),
            within(a.y + t * (static_cast<long double>(b.y) - a.y), std::max(box.low.y, other.low.y),
                   std::min(box.high.y, other.high.y))};
  }

  /// One that is there, or a new one.
  std::int32_t point_at(const Point& exact) {
    const Point p{rounded_to(exact.x, kInputGrid) + 0.0, rounded_to(exact.y, kInputGrid) + 0.0};
    if (by_place_.empty())
      for (const std::int32_t i : first_ids<std::int32_t>(result_.points.size()))
        by_place_.emplace(Place{at(i).x + 0.0, at(i).y + 0.0}, i);
    const auto [entry, added] =
        by_place_.try_emplace(Place{p.x, p.y}, static_cast<std::int32_t>(result_.points.size()));
    if (added) result_.points.push_back(p);
    return entry->second;
  }

  void cut() {
    for (const std::int32_t e : first_ids<std::int32_t>(edges_.size())) {
      const Point &a = at(edges_[e].first), &b = at(edges_[e].second);
      std::vector<std::int32_t>& cuts = cuts_[e];
      std::ranges::sort(cuts);
      cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
      std::ranges::stable_sort(cuts, {}, [&](std::int32_t point) { return dot_extended(a, b, at(point)); });
    }
    for (Pslg::Polygon& polygon : result_.polygons)
      for (Pslg::Ring& ring : polygon.rings) ring = with_cuts(ring);
  }

  [[nodiscard]] Pslg::Ring with_cuts(const Pslg::Ring& ring) const {
    Pslg::Ring result;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const std::int32_t a = ring[i], b = ring[(i + 1) % ring.size()];
      result.push_back(a);
      const auto edge = std::ranges::lower_bound(edges_, Ends(std::minmax(a, b)));
      const std::vector<std::int32_t>& cuts = cuts_[edge - edges_.begin()];
      if (a < b)
        result.insert(result.end(), cuts.begin(), cuts.end());
      else
        result.insert(result.end(), cuts.rbegin(), cuts.rend());
    }
    return result;
  }

  struct Place {
    double x, y;
    friend bool operator==(const Place&, const Place&) = default;
  };
  struct PlaceHash {
    std::size_t operator()(const Place& p) const {
      return std::hash<double>()(p.x) * 0x9e3779b97f4a7c15U + std::hash<double>()(p.y);
    }
  };

  Pslg result_;
  std::vector<Ends> edges_;                      // ascending, each once
  std::vector<std::vector<std::int32_t>> cuts_;  // the points on each edge
  std::unordered_map<Place, std::int32_t, PlaceHash> by_place_;
};

}  // namespace

std::optional<Pslg> rings_alone(const Pslg& input) {
  const auto in_range = [](const Point& p) { return in_input_range(p.x) && in_input_range(p.y); };
  if (!std::ranges::all_of(input.points, in_range)) return std::nullopt;
  PointIndex index(input.points);
  std::vector<std::int32_t> first;
  for (const std::int32_t i : first_ids<std::int32_t>(input.points.size())) first.push_back(index.add(i));
  Pslg result;
  result.points = input.points;
  result.regions = input.regions;
  for (const Pslg::Polygon& given : input.polygons) {
    Pslg::Polygon& polygon = result.polygons.emplace_back();
    polygon.region = given.region;
    for (const Pslg::Ring& given_ring : given.rings) {
      Pslg::Ring& ring = polygon.rings.emplace_back();
      for (const std::int32_t corner : given_ring) {
        if (to_index(corner) >= first.size()) return std::nullopt;
        if (ring.empty() || ring.back() != first[corner]) ring.push_back(first[corner]);
      }
      while (!ring.empty() && ring.back() == ring.front()) ring.pop_back();
    }
  }
  set_segments(result);
  return result;
}

std::optional<Pslg> cut_rings(Pslg rings) {
  return RingCutter(std::move(rings)).run();
}

}  // namespace driftmesh
