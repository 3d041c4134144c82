#include "geojson/around_pole.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "geojson/dateline.hpp"
#include "geojson/each_point.hpp"

namespace driftmesh {
namespace {

constexpr double kLongest = 4;  // degrees of longitude

bool is_circle(double difference) {
  return std::abs(std::abs(difference) - 360) < 1e-9;
}

bool is_pole(const Point& p) {
  return std::abs(p.y) == 90;
}

/// From the longitude of `a` to that of `b`.
double way(const Point& a, const Point& b) {
  const double difference = b.x - a.x;
  return is_circle(difference) ? difference : std::remainder(difference, 360);
}

const Point& after(const PolygonRing& ring, std::size_t i) {
  return ring[i + 1 == ring.size() ? 0 : i + 1];
}

bool goes_around(const PolygonRing& ring) {
  double turned = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const double step = way(ring[i], after(ring, i));
    if (is_circle(step)) return true;
    turned += step;
  }
  return std::abs(turned) > 180;
}

/// The same points for an edge in both directions.
void append_between(Point a, Point b, std::vector<Point>& all) {
  if (is_pole(a) && is_pole(b)) return;
  const double step = way(a, b);
  const auto parts = static_cast<int>(std::ceil(std::abs(step) / kLongest - 1e-9));
  if (parts <= 1) return;
  const bool is_reversed = step < 0;
  const Point& west = is_reversed ? b : a;
  const Point& east = is_reversed ? a : b;
  const auto at = [&](int k) {
    const double t = static_cast<double>(k) / parts;
    return Point{west.x + t * std::abs(step), west.y + t * (east.y - west.y)};
  };
  for (int k = 1; k < parts; ++k) all.push_back(at(is_reversed ? parts - k : k));
}

void divide(std::vector<Point>& points, bool closed) {
  std::vector<Point> all;
  for (std::size_t i = 0; i < points.size(); ++i) {
    all.push_back(points[i]);
    if (closed || i + 1 < points.size()) append_between(points[i], after(points, i), all);
  }
  points = std::move(all);
}

/// Removes repetitions and ways to and fro, also across the first point.
PolygonRing without_spikes(const PolygonRing& ring) {
  PolygonRing kept;
  const auto settle = [&] {
    for (;;) {
      const std::size_t n = kept.size();
      if (n >= 2 && kept[n - 1] == kept[n - 2])
        kept.pop_back();
      else if (n >= 3 && kept[n - 1] == kept[n - 3])
        kept.resize(n - 2);
      else
        return;
    }
  };
  for (const Point& p : ring) {
    kept.push_back(p);
    settle();
  }
  for (;;) {
    const std::size_t n = kept.size();
    const bool is_closed = n >= 2 && kept.front() == kept.back();
    if (!is_closed && n >= 3 && kept[1] == kept.back())
      kept.erase(kept.begin());
    else if (is_closed || (n >= 3 && kept.front() == kept[n - 2]))
      kept.pop_back();
    else
      return kept;
  }
}

/// Cuts a ring apart where it walks an edge along the 180th meridian in both directions: the way between two rings.
void split_at_ways(PolygonRing ring, std::vector<PolygonRing>& rings) {
  std::map<std::array<double, 2>, std::size_t> walked;  // edges from latitude to latitude
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point &a = ring[i], &b = after(ring, i);
    if (a.x != -180 || b.x != -180) continue;
    walked[{a.y, b.y}] = i;
    const auto back = walked.find({b.y, a.y});
    if (back == walked.end()) continue;
    const auto at = [&](std::size_t k) { return ring.begin() + static_cast<std::ptrdiff_t>(k); };
    PolygonRing inner(at(back->second + 1), at(i));  // from where the way ends, and without that point again
    ring.erase(at(back->second), at(i));
    split_at_ways(without_spikes(inner), rings);
    return split_at_ways(without_spikes(ring), rings);
  }
  if (ring.size() >= 3) rings.push_back(std::move(ring));
}

/// Nearer to the equator comes first: it is around the others.
double least_latitude(const PolygonRing& ring) {
  return std::ranges::min(ring, {}, [](const Point& p) { return std::abs(p.y); }).y;
}

}  // namespace

bool goes_around(const GeoFeatures& features) {
  const auto has_circle = [](const GeoFeatures::Line& line) {
    for (std::size_t i = 1; i < line.points.size(); ++i)
      if (is_circle(line.points[i].x - line.points[i - 1].x)) return true;
    return false;
  };
  return std::ranges::any_of(features.lines, has_circle) ||
         std::ranges::any_of(features.polygons, [](const GeoFeatures::Polygon& polygon) {
           return std::ranges::any_of(polygon.rings, [](const PolygonRing& ring) { return goes_around(ring); });
         });
}

void divide_long_edges(GeoFeatures& features) {
  for (GeoFeatures::Polygon& polygon : features.polygons)
    for (PolygonRing& ring : polygon.rings) divide(ring, true);
  for (GeoFeatures::Line& line : features.lines) divide(line.points, false);
}

void close_at_dateline(GeoFeatures& features) {
  for_each_point(features, [](Point& p) { p.x = is_pole(p) ? 0 : canonical_longitude(p.x); });
  for (GeoFeatures::Polygon& polygon : features.polygons) {
    std::vector<PolygonRing> rings;
    split_at_ways(without_spikes(polygon.rings.front()), rings);
    std::ranges::stable_sort(rings, {}, [](const PolygonRing& ring) { return std::abs(least_latitude(ring)); });
    for (std::size_t k = 1; !rings.empty() && k < polygon.rings.size(); ++k)
      if (PolygonRing hole = without_spikes(polygon.rings[k]); hole.size() >= 3) rings.push_back(std::move(hole));
    polygon.rings = std::move(rings);
  }
  std::erase_if(features.polygons, [](const GeoFeatures::Polygon& polygon) { return polygon.rings.empty(); });
}

}  // namespace driftmesh
