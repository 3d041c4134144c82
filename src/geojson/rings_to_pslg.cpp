#include "geojson/rings_to_pslg.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "base/narrow.hpp"
#include "driftmesh/error.hpp"
#include "geometry/box.hpp"
#include "gis/transverse_mercator.hpp"

namespace driftmesh {
namespace {

constexpr double kFarthest = 40;  // degrees from the middle

template <class Visit>
void for_each_point(GeoFeatures& features, const Visit& visit) {
  for (GeoFeatures::Polygon& polygon : features.polygons)
    for (PolygonRing& ring : polygon.rings) std::ranges::for_each(ring, visit);
  for (GeoFeatures::Line& line : features.lines) std::ranges::for_each(line.points, visit);
  std::ranges::for_each(features.points, visit);
}

/// Numbers points and segments, each once.
class PslgBuilder {
 public:
  void add_chain(const std::vector<Point>& points, bool closed, std::int32_t marker) {
    for (std::size_t i = 0; i + (closed ? 0 : 1) < points.size(); ++i) {
      const std::int32_t a = number(points[i]), b = number(points[i + 1 == points.size() ? 0 : i + 1]);
      if (listed_.insert(std::minmax({a, b})).second) pslg_.segments.push_back({a, b, marker});
    }
  }
  void add_point(Point p) { static_cast<void>(number(p)); }

  [[nodiscard]] Pslg& pslg() { return pslg_; }

 private:
  std::int32_t number(Point p) {
    const auto [known, is_new] = numbers_.try_emplace({p.x, p.y}, 0);
    if (is_new) {
      known->second = narrow<std::int32_t>(pslg_.points.size(), "points of the input");
      pslg_.points.push_back(p);
    }
    return known->second;
  }

  Pslg pslg_;
  std::map<std::pair<double, double>, std::int32_t> numbers_;
  std::set<std::pair<std::int32_t, std::int32_t>> listed_;
};

/// All rings by the left end of their boxes, to find those within another one.
class RingIndex {
 public:
  explicit RingIndex(const GeoFeatures& features) {
    for (const GeoFeatures::Polygon& polygon : features.polygons)
      for (const PolygonRing& ring : polygon.rings) rings_.push_back({Box::of(ring), &ring});
    std::ranges::sort(rings_, {}, &Entry::left);
  }

  /// The ring, and those whose boxes lie within its box.
  [[nodiscard]] std::vector<const PolygonRing*> with_those_inside(const PolygonRing& ring) const {
    const Box box = Box::of(ring);
    std::vector<const PolygonRing*> found{&ring};
    for (auto at = std::ranges::lower_bound(rings_, box.low.x, {}, &Entry::left);
         at != rings_.end() && at->left() <= box.high.x; ++at)
      if (at->ring != &ring && at->box.high.x <= box.high.x && at->box.low.y >= box.low.y &&
          at->box.high.y <= box.high.y)
        found.push_back(at->ring);
    return found;
  }

 private:
  struct Entry {
    Box box;
    const PolygonRing* ring = nullptr;
    [[nodiscard]] double left() const { return box.low.x; }
  };
  std::vector<Entry> rings_;
};

}  // namespace

std::string project(GeoFeatures& features, const std::string& file) {
  Box box;
  for_each_point(features, [&](Point& p) {
    if (std::abs(p.x) > 180 || std::abs(p.y) > 90)
      throw InputError({file, 0}, "has coordinates that are no longitude and latitude",
                       "GeoJSON is in degrees; for other coordinates, name their system in a \"crs\"");
    if (p.y > 84 || p.y < -80)
      throw InputError({file, 0}, "reaches beyond 84 degrees north or 80 degrees south, where UTM ends",
                       "project it yourself, and name the system in a \"crs\"");
    box.extend(p);
  });
  const double middle = (box.low.x + box.high.x) / 2;
  const UtmZone zone = utm_zone_of(middle, (box.low.y + box.high.y) / 2);
  if (box.high.x - zone.central_meridian() > kFarthest || zone.central_meridian() - box.low.x > kFarthest)
    throw InputError(
        {file, 0}, "spans too many degrees of longitude for one UTM zone",
        "cut it at the antimeridian if it crosses that, or project it yourself and name the system in a \"crs\"");
  for_each_point(features, [&](Point& p) { p = utm(p.x, p.y, zone); });
  return zone.name();
}

Pslg to_pslg(const GeoFeatures& features, const std::string& file) {
  PslgBuilder builder;
  builder.pslg().names = features.names;
  for (const GeoFeatures::Line& line : features.lines) builder.add_chain(line.points, false, line.marker);
  const RingIndex index(features);
  for (const GeoFeatures::Polygon& polygon : features.polygons) {
    const auto fail = [&](const char* what) {
      throw InputError({file, 0},
                       "feature " + std::to_string(polygon.feature) + " has " + what + " without room inside",
                       "remove it, or correct rings that cross");
    };
    std::vector<const PolygonRing*> own;
    for (const PolygonRing& ring : polygon.rings) {
      const bool is_hole = !own.empty();
      builder.add_chain(ring, true, polygon.marker.value_or(is_hole ? kGeoIsland : kGeoLand));
      if (is_hole) {
        const auto rings = index.with_those_inside(ring);
        if (const auto p = interior_point(rings))
          builder.pslg().holes.push_back(*p);
        else if (rings.size() == 1)  // otherwise other polygons fill it
          fail("a hole");
      }
      own.push_back(&ring);
    }
    if (!polygon.region) continue;
    const auto p = interior_point(own);
    if (!p) fail("a region");
    builder.pslg().regions.push_back({*p, polygon.region->attribute, polygon.region->max_area});
  }
  for (const Point p : features.points) builder.add_point(p);
  return std::move(builder.pslg());
}

}  // namespace driftmesh
