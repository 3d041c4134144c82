#include "geojson/dateline.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "base/disjoint_sets.hpp"
#include "geojson/each_point.hpp"

namespace driftmesh {
namespace {

constexpr double kDateline = 180;
constexpr double kRounded = 1e10;  // rounds to parts of a degree

double turned(double longitude) {
  return longitude >= -180 && longitude < 180 ? longitude : longitude - 360 * std::floor((longitude + 180) / 360);
}

double rounded(double longitude) {
  return std::round(longitude * kRounded) / kRounded;
}

/// Where the interval without the largest gap begins, from -180 to 180.
double first_longitude(GeoFeatures& features) {
  std::vector<double> longitudes;
  for_each_point(features, [&](const Point& p) { longitudes.push_back(canonical_longitude(p.x)); });
  std::ranges::sort(longitudes);
  double first = longitudes.front(), widest = longitudes.front() + 360 - longitudes.back();
  for (std::size_t i = 1; i < longitudes.size(); ++i)
    if (const double gap = longitudes[i] - longitudes[i - 1]; gap > widest) first = longitudes[i], widest = gap;
  return first;
}

// ---- Polygons that were cut --------------------------------------------------------------------------------------

struct Before {
  bool operator()(const Point& a, const Point& b) const { return a.x != b.x ? a.x < b.x : a.y < b.y; }
};
using Border = std::pair<Point, Point>;

bool is_on_dateline(const Border& edge) {
  return edge.first.x == kDateline && edge.second.x == kDateline;
}

double doubled_area(const PolygonRing& ring) {
  double sum = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point &a = ring[i], &b = ring[i + 1 == ring.size() ? 0 : i + 1];
    sum += (a.x - ring[0].x) * (b.y - ring[0].y) - (b.x - ring[0].x) * (a.y - ring[0].y);
  }
  return sum;
}

/// Rings whose polygons lie on their left, cut at all heights where a ring has a corner on the dateline.
class Borders {
 public:
  explicit Borders(const std::vector<GeoFeatures::Polygon>& polygons) {
    for (const GeoFeatures::Polygon& polygon : polygons)
      for (const PolygonRing& ring : polygon.rings)
        for (const Point& p : ring)
          if (p.x == kDateline) heights_.insert(p.y);
  }

  [[nodiscard]] std::vector<Border> of(PolygonRing ring, bool is_hole) const {
    if ((doubled_area(ring) < 0) != is_hole) std::ranges::reverse(ring);
    std::vector<Border> edges;
    for (std::size_t i = 0; i < ring.size(); ++i) append({ring[i], ring[i + 1 == ring.size() ? 0 : i + 1]}, edges);
    return edges;
  }

 private:
  void append(const Border& edge, std::vector<Border>& edges) const {
    if (!is_on_dateline(edge)) return edges.push_back(edge);
    const auto [low, high] = std::minmax(edge.first.y, edge.second.y);
    std::vector<double> between(heights_.lower_bound(low), heights_.upper_bound(high));
    if (edge.first.y > edge.second.y) std::ranges::reverse(between);
    for (std::size_t i = 1; i < between.size(); ++i)
      edges.push_back({{kDateline, between[i - 1]}, {kDateline, between[i]}});
  }

  std::set<double> heights_;
};

/// Follows edges into rings. Where several continue, the sharpest turn to the left is taken, so that rings that touch
/// in a point are rings of their own.
std::vector<PolygonRing> rings_of(const std::vector<Border>& edges) {
  std::map<Point, std::vector<Point>, Before> next;
  for (const Border& edge : edges) next[edge.first].push_back(edge.second);
  const auto take = [&](const Point& at, const Point& from) {
    std::vector<Point>& ends = next[at];
    const double back = std::atan2(from.y - at.y, from.x - at.x);
    const auto clockwise_from_back = [&](const Point& end) {
      const double angle = back - std::atan2(end.y - at.y, end.x - at.x);
      return angle > 0 ? angle : angle + 2 * std::numbers::pi;
    };
    const auto best = std::ranges::min_element(ends, {}, clockwise_from_back);
    const Point end = *best;
    ends.erase(best);
    return end;
  };
  std::vector<PolygonRing> rings;
  for (const Border& edge : edges) {
    if (next[edge.first].empty()) continue;
    PolygonRing ring{edge.first};
    for (Point at = take(edge.first, edge.first), from = edge.first; at != edge.first;) {
      ring.push_back(at);
      const Point end = take(at, from);
      from = at;
      at = end;
    }
    if (ring.size() >= 3) rings.push_back(std::move(ring));
  }
  return rings;
}

/// The polygons that the rings bound: those that run counterclockwise, each with the others that lie in it.
std::vector<std::vector<PolygonRing>> nested(std::vector<PolygonRing> rings) {
  const auto holes =
      std::stable_partition(rings.begin(), rings.end(), [](const PolygonRing& ring) { return doubled_area(ring) > 0; });
  std::vector<std::vector<PolygonRing>> polygons;
  for (auto ring = rings.begin(); ring != holes; ++ring) polygons.push_back({std::move(*ring)});
  for (auto hole = holes; hole != rings.end(); ++hole) {
    const auto around = std::ranges::find_if(polygons, [&](const std::vector<PolygonRing>& polygon) {
      const PolygonRing* const outer = &polygon.front();
      return std::ranges::count_if(*hole,
                                   [&](const Point& p) {
                                     return is_inside({&outer, 1}, p);
                                   }) *
                 2 >
             std::ssize(*hole);
    });
    if (around != polygons.end()) around->push_back(std::move(*hole));
  }
  return polygons;
}

/// Which polygons are one, and what is left of their borders.
class Joined {
 public:
  explicit Joined(const std::vector<GeoFeatures::Polygon>& polygons) : polygons_(polygons), sets_(polygons.size()) {
    const Borders borders(polygons);
    edges_.resize(polygons.size());
    for (std::size_t k = 0; k < polygons.size(); ++k)
      for (std::size_t r = 0; r < polygons[k].rings.size(); ++r)
        for (const Border& edge : borders.of(polygons[k].rings[r], r > 0)) add(k, edge);
  }

  [[nodiscard]] std::vector<GeoFeatures::Polygon> take() {
    std::map<std::int32_t, std::vector<std::size_t>> members;  // by the first of them
    for (std::size_t k = 0; k < polygons_.size(); ++k) members[sets_.find(static_cast<std::int32_t>(k))].push_back(k);
    std::vector<GeoFeatures::Polygon> result;
    for (const auto& [root, all] : members) {
      const std::size_t first = all.front();
      if (all.size() == 1) {
        result.push_back(polygons_[first]);
        continue;
      }
      std::vector<Border> left;
      for (const std::size_t k : all) left.insert(left.end(), edges_[k].begin(), edges_[k].end());
      for (std::vector<PolygonRing>& rings : nested(rings_of(left))) {
        result.push_back(polygons_[first]);
        result.back().rings = std::move(rings);
      }
    }
    return result;
  }

 private:
  /// Cancels the edge against that of another polygon that is alike, if there is one.
  void add(std::size_t k, const Border& edge) {
    if (!is_on_dateline(edge)) return edges_[k].push_back(edge);
    auto& waiting = waiting_[{edge.second.y, edge.first.y}];
    const auto other =
        std::ranges::find_if(waiting, [&](std::size_t j) { return are_alike(polygons_[k], polygons_[j]); });
    if (other == waiting.end()) {
      waiting_[{edge.first.y, edge.second.y}].push_back(k);
      return edges_[k].push_back(edge);
    }
    std::erase(edges_[*other], Border{edge.second, edge.first});
    sets_.join(static_cast<std::int32_t>(k), static_cast<std::int32_t>(*other));
    waiting.erase(other);
  }

  static bool are_alike(const GeoFeatures::Polygon& a, const GeoFeatures::Polygon& b) {
    const auto region = [](const GeoFeatures::Polygon& polygon) {
      return polygon.region ? std::optional(std::pair(polygon.region->attribute, polygon.region->max_area))
                            : std::nullopt;
    };
    return a.marker == b.marker && region(a) == region(b);
  }

  const std::vector<GeoFeatures::Polygon>& polygons_;
  DisjointSets<> sets_;
  std::vector<std::vector<Border>> edges_;                                 // one list for each polygon
  std::map<std::pair<double, double>, std::vector<std::size_t>> waiting_;  // polygons with this edge, by its heights
};

}  // namespace

double canonical_longitude(double longitude) {
  return rounded(turned(longitude));
}

void unwrap_longitudes(GeoFeatures& features) {
  const double first = first_longitude(features);
  const auto unwrapped = [&](double longitude) {
    const double canonical = canonical_longitude(longitude);
    return canonical < first ? canonical + 360 : canonical;
  };
  bool changes = false;
  for_each_point(features, [&](const Point& p) { changes = changes || std::abs(unwrapped(p.x) - p.x) > 1; });
  if (changes) for_each_point(features, [&](Point& p) { p.x = rounded(unwrapped(p.x)); });
}

void join_at_dateline(GeoFeatures& features) {
  bool is_west = false, is_east = false;
  for_each_point(features, [&](const Point& p) {
    is_west = is_west || p.x < kDateline;
    is_east = is_east || p.x > kDateline;
  });
  if (is_west && is_east) features.polygons = Joined(features.polygons).take();
}

}  // namespace driftmesh
