#include "geojson/geojson.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "driftmesh/error.hpp"
#include "gis/geographic_system.hpp"
#include "gis/mercator.hpp"
#include "gis/transverse_mercator.hpp"

namespace driftmesh {
namespace {

using Json = nlohmann::json;

constexpr int kDeepest = 16;  // collections within collections
constexpr const char* kFormat = "RFC 7946 describes the format";

Json parse_json(const std::string& file, std::string_view text) {
  try {
    return Json::parse(text.begin(), text.end());
  } catch (const Json::parse_error& error) {
    const std::string_view before = text.substr(0, std::min<std::size_t>(error.byte, text.size()));
    const auto line = 1 + static_cast<std::size_t>(std::ranges::count(before, '\n'));
    throw InputError({file, line}, "is not valid JSON here", "it was not written completely, or is damaged");
  } catch (const Json::out_of_range&) {
    throw InputError({file, 0}, "has a number beyond the range of double precision", "correct it");
  }
}

class FeatureReader {
 public:
  explicit FeatureReader(const std::string& file) : file_(file) {}

  GeoFeatures read(const Json& root) {
    read_system(root);
    const std::string type = type_of(root);
    if (type == "FeatureCollection")
      for (const Json& feature : array_in(root, "features")) read_feature(feature);
    else if (type == "Feature")
      read_feature(root);
    else
      ++feature_, read_geometry(root, Json::object(), 0);
    if (found_.polygons.empty() && found_.lines.empty() && found_.points.empty())
      throw InputError({file_, 0}, found_.warnings.empty() ? "has no geometry" : found_.warnings.front(),
                       "there is nothing to mesh");
    return std::move(found_);
  }

 private:
  [[noreturn]] void fail(const std::string& what, const char* next = kFormat) const {
    throw InputError({file_, 0}, (feature_ > 0 ? "feature " + std::to_string(feature_) + " " : "") + what, next);
  }

  /// GeoJSON of 2008 could name another system; names of the default one vary.
  void read_system(const Json& root) {
    const auto crs = root.is_object() ? root.find("crs") : root.end();
    if (!root.is_object() || crs == root.end() || crs->is_null()) return;
    found_.system = system_in(*crs);
    if (found_.system.empty())
      fail("has a member \"crs\" that names no system", "remove it if coordinates are longitudes and latitudes");
    found_.in_degrees = is_geographic_system(found_.system);
    const int code = epsg_code_in(found_.system);
    if (const auto zone = utm_zone_of_epsg(code)) found_.projection = zone->name();
    use_mercator(code);
  }

  /// By its name, by the number of an authority, or by an address.
  [[nodiscard]] static std::string system_in(const Json& crs) {
    const auto member = [&](const char* of) {
      const Json::json_pointer place(of);
      return crs.is_object() && crs.contains(place) ? crs[place] : Json();
    };
    for (const char* name : {"/properties/name", "/properties/href"})
      if (const Json text = member(name); text.is_string()) return text.get<std::string>();
    const Json authority = member("/type"), code = member("/properties/code");
    if (!authority.is_string() || code.is_null()) return "";
    return authority.get<std::string>() + ":" + (code.is_string() ? code.get<std::string>() : code.dump());
  }

  /// Positions in Mercator's projection become degrees when they are read.
  void use_mercator(int code) {
    mercator_ = mercator_of_code(code);
    if (mercator_) found_.in_degrees = true;
  }

  [[nodiscard]] std::string type_of(const Json& object) const {
    const auto type = object.is_object() ? object.find("type") : object.end();
    if (!object.is_object() || type == object.end() || !type->is_string()) fail("has no type");
    return type->get<std::string>();
  }

  [[nodiscard]] const Json& array_in(const Json& object, const char* name) const {
    const auto found = object.find(name);
    if (found == object.end() || !found->is_array()) fail("has no array \"" + std::string(name) + "\"");
    return *found;
  }

  void read_feature(const Json& feature) {
    ++feature_;
    if (type_of(feature) != "Feature") fail("has type \"" + type_of(feature) + "\" instead of \"Feature\"");
    const auto geometry = feature.find("geometry"), properties = feature.find("properties");
    if (geometry == feature.end() || geometry->is_null()) return;  // a feature without a place
    const Json none = Json::object();
    const Json& known = properties != feature.end() && properties->is_object() ? *properties : none;
    read_geometry(*geometry, known, 0);
    read_name(known);
  }

  /// Names the region or the marker whose number the feature has: features of one kind may have names of their own.
  void read_name(const Json& properties) {
    const auto name = properties.find("name");
    if (name == properties.end() || !name->is_string()) return;
    if (const auto region = number_in(properties, "region"))
      give_name(found_.names.regions, *region, "region", *name);
    else if (number_in(properties, "marker"))
      give_name(found_.names.markers, *marker_in(properties), "marker", *name);
  }

  template <class Value>
  void give_name(std::map<Value, std::string>& names, Value value, const char* what, const std::string& name) const {
    const auto known = names.try_emplace(value, name).first;
    if (known->second != name)
      fail("calls its " + std::string(what) + " '" + name + "', but another feature '" + known->second + "'",
           "give each a number of its own");
  }

  void read_geometry(const Json& geometry, const Json& properties, int depth) {
    const std::string type = type_of(geometry);
    if (type == "GeometryCollection") {
      if (depth == kDeepest) fail("has collections that are nested too deeply");
      for (const Json& part : array_in(geometry, "geometries")) read_geometry(part, properties, depth + 1);
      return;
    }
    const Json& c = array_in(geometry, "coordinates");
    const auto each = [&](const auto& read) {
      for (const Json& part : c) read(part);
    };
    if (type == "Polygon") return add_polygon(c, properties);
    if (type == "MultiPolygon") return each([&](const Json& part) { add_polygon(part, properties); });
    if (type == "LineString") return add_line(c, properties);
    if (type == "MultiLineString") return each([&](const Json& part) { add_line(part, properties); });
    if (type == "Point") return found_.points.push_back(position(c));
    if (type == "MultiPoint") return each([&](const Json& part) { found_.points.push_back(position(part)); });
    fail("has a geometry of unknown type \"" + type + "\"");
  }

  void add_polygon(const Json& rings, const Json& properties) {
    if (!rings.is_array()) fail("has a polygon that is no array of rings");
    if (rings.empty()) return;
    GeoFeatures::Polygon polygon{feature_, {}, marker_in(properties), region_in(properties)};
    for (const Json& positions : rings) {
      PolygonRing ring = positions_in(positions);
      if (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
      if (ring.size() < 3)
        found_.warnings.push_back("feature " + std::to_string(feature_) +
                                  " has a ring of fewer than three different corners, which covers nothing");
      else
        polygon.rings.push_back(std::move(ring));
      if (polygon.rings.empty()) return;  // the outer one covers nothing
    }
    found_.polygons.push_back(std::move(polygon));
  }

  void add_line(const Json& positions, const Json& properties) {
    GeoFeatures::Line line{positions_in(positions), marker_in(properties).value_or(0)};
    if (line.points.size() < 2) fail("has a line of fewer than two different points", "remove it");
    found_.lines.push_back(std::move(line));
  }

  /// Without repetitions.
  [[nodiscard]] std::vector<Point> positions_in(const Json& positions) const {
    if (!positions.is_array()) fail("has something else in place of an array of positions");
    std::vector<Point> points;
    for (const Json& p : positions)
      if (const Point next = position(p); points.empty() || points.back() != next) points.push_back(next);
    return points;
  }

  [[nodiscard]] Point position(const Json& p) const {
    if (!p.is_array() || p.size() < 2 || !p[0].is_number() || !p[1].is_number())
      fail("has a position that is no array of two numbers");
    const Point place{p[0].get<double>(), p[1].get<double>()};
    return mercator_ ? geographic(place, *mercator_) : place;
  }

  [[nodiscard]] std::optional<double> number_in(const Json& properties, const char* name) const {
    const auto found = properties.find(name);
    if (found == properties.end() || found->is_null()) return std::nullopt;
    if (!found->is_number()) fail("has a \"" + std::string(name) + "\" that is no number", "correct or remove it");
    return found->get<double>();
  }

  [[nodiscard]] std::optional<std::int32_t> marker_in(const Json& properties) const {
    if (const auto marker = number_in(properties, "marker")) {
      if (*marker != std::floor(*marker) || std::abs(*marker) > INT32_MAX)
        fail("has a \"marker\" that is no whole number of 32 bits", "markers of segments are whole numbers");
      return static_cast<std::int32_t>(*marker);
    }
    const auto boundary = properties.find("boundary");
    if (boundary == properties.end() || boundary->is_null()) return std::nullopt;
    for (const auto& [name, marker] : {std::pair{"land", kGeoLand}, {"island", kGeoIsland}, {"open", kGeoOpen}})
      if (*boundary == name) return marker;
    fail("has a \"boundary\" of an unknown kind", "kinds are \"land\", \"island\" and \"open\"");
  }

  [[nodiscard]] std::optional<GeoFeatures::Region> region_in(const Json& properties) const {
    const auto attribute = number_in(properties, "region"), max_area = number_in(properties, "max_area");
    if (!attribute && !max_area) return std::nullopt;
    if (max_area && *max_area <= 0) fail("has a \"max_area\" that is not positive", "correct or remove it");
    return GeoFeatures::Region{attribute.value_or(0), max_area.value_or(0)};
  }

  const std::string& file_;
  std::size_t feature_ = 0;           // the one at hand; 0: none
  std::optional<Mercator> mercator_;  // the projection that positions are in
  GeoFeatures found_;
};

}  // namespace

GeoFeatures parse_geojson(const std::string& file, std::string_view text) {
  return FeatureReader(file).read(parse_json(file, text));
}

}  // namespace driftmesh
