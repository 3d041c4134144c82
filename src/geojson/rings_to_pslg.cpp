#include "geojson/rings_to_pslg.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "base/narrow.hpp"
#include "driftmesh/error.hpp"
#include "geojson/around_pole.hpp"
#include "geojson/choose_projection.hpp"
#include "geojson/dateline.hpp"
#include "geojson/each_point.hpp"
#include "geojson/vertices_on_edges.hpp"
#include "gis/projection.hpp"

namespace driftmesh {
namespace {

/// Numbers points, segments and regions, each once.
class PslgBuilder {
 public:
  void add_line(const std::vector<Point>& points, std::int32_t marker) {
    for (std::size_t i = 0; i + 1 < points.size(); ++i) join(number(points[i]), number(points[i + 1]), marker);
  }
  void add_polygon(const GeoFeatures::Polygon& polygon) {
    Pslg::Polygon& added = pslg_.polygons.emplace_back();
    added.feature = narrow<std::int32_t>(polygon.feature, "features");
    if (polygon.region) added.region = number(*polygon.region);
    for (const PolygonRing& ring : polygon.rings)
      added.rings.push_back(add_ring(ring, polygon.marker.value_or(added.rings.empty() ? kGeoLand : kGeoIsland)));
  }
  void add_point(Point p) { static_cast<void>(number(p)); }

  [[nodiscard]] Pslg& pslg() { return pslg_; }

 private:
  Pslg::Ring add_ring(const PolygonRing& points, std::int32_t marker) {
    Pslg::Ring ring;
    for (const Point p : points) {
      ring.push_back(number(p));
      if (ring.size() > 1) join(ring[ring.size() - 2], ring.back(), marker);
    }
    join(ring.back(), ring.front(), marker);
    return ring;
  }

  void join(std::int32_t a, std::int32_t b, std::int32_t marker) {
    if (listed_.insert(std::minmax({a, b})).second) pslg_.segments.push_back({a, b, marker});
  }

  std::int32_t number(Point p) {
    const auto [known, is_new] = numbers_.try_emplace({p.x, p.y}, 0);
    if (is_new) {
      known->second = narrow<std::int32_t>(pslg_.points.size(), "points of the input");
      pslg_.points.push_back(p);
    }
    return known->second;
  }

  std::int32_t number(const GeoFeatures::Region& region) {
    const auto [known, is_new] = regions_.try_emplace({region.attribute, region.max_area}, 0);
    if (is_new) {
      known->second = narrow<std::int32_t>(pslg_.regions.size(), "regions of the input");
      pslg_.regions.push_back({{}, region.attribute, region.max_area});
    }
    return known->second;
  }

  Pslg pslg_;
  std::map<std::pair<double, double>, std::int32_t> numbers_, regions_;
  std::set<std::pair<std::int32_t, std::int32_t>> listed_;
};

}  // namespace

std::string project(GeoFeatures& features, const std::string& asked, const std::string& file) {
  for_each_point(features, [&](const Point& p) {
    if (std::abs(p.x) > 360 || std::abs(p.y) > 90)
      throw InputError({file, 0}, "has coordinates that are no longitude and latitude",
                       "GeoJSON is in degrees; for other coordinates, name their system in a \"crs\"");
  });
  const bool around_pole = goes_around(features);
  if (!around_pole) {
    unwrap_longitudes(features);
    join_at_dateline(features);
  }
  std::vector<Point> places;
  for_each_point(features, [&](const Point& p) { places.push_back(p); });
  const Projection plane = given_projection(asked, places, around_pole, file);
  if (!plane.is_utm()) divide_long_edges(features);
  const auto projected = [&](const Point& p) { return plane.plane(p); };
  if (around_pole) {
    close_at_dateline(features);
    for_each_point(features, [&](Point& p) { p = projected(p); });
  } else {
    project_with_edges(features, projected);
  }
  return plane.name();
}

Pslg to_pslg(const GeoFeatures& features) {
  PslgBuilder builder;
  builder.pslg().names = features.names;
  for (const GeoFeatures::Line& line : features.lines) builder.add_line(line.points, line.marker);
  for (const GeoFeatures::Polygon& polygon : features.polygons) builder.add_polygon(polygon);
  for (const Point p : features.points) builder.add_point(p);
  return std::move(builder.pslg());
}

}  // namespace driftmesh
